"""What readers of traces have in common: entities, rows and tables, and the order of times."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import ClassVar, TypeAlias

import numpy as np

from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.trace.files import TracePlace, TraceProblems
from amalthea_uros.trace.table import NO_NOTE, Entity, EntityKind, EventKind, EventTable
from amalthea_uros.trace.vocabulary import OS_EVENTS, PROCESSES


class EntityIndex:
    """Gives entities their indices.

    Attributes
    ----------
    entities : grows while the trace is read
    """

    def __init__(self) -> None:
        self.entities: list[Entity] = []
        self._indices: dict[Entity, int] = {}
        self._assumed: dict[str, int] = {}

    def index(self, kind: EntityKind, name: str) -> int:
        """The index of an entity whose type is known."""
        entity = Entity(kind, name)
        if entity not in self._indices:
            assumed = self._assumed.pop(name, None)
            if assumed is not None and _are_alike(self.entities[assumed].kind, kind):
                # So far it has only been a source, and its type a guess.
                self.entities[assumed] = entity
                self._indices[entity] = assumed
            else:
                self._indices[entity] = len(self.entities)
                self.entities.append(entity)
        return self._indices[entity]

    def source_index(self, name: str, kinds: Sequence[EntityKind]) -> int:
        """The index of an entity that is of one of some types: of the first that is known, or else of the first."""
        known = (self._indices.get(Entity(kind, name)) for kind in kinds)
        found = next((index for index in known if index is not None), None)
        if found is not None:
            return found
        assumed = self._assumed.get(name)
        if assumed is not None and self.entities[assumed].kind in kinds:
            return assumed
        if len(kinds) == 1:
            return self.index(kinds[0], name)
        self._assumed[name] = len(self.entities)
        self.entities.append(Entity(kinds[0], name))
        return self._assumed[name]


def _are_alike(assumed: EntityKind, kind: EntityKind) -> bool:
    """Whether something that was taken for one type as a source can be of another."""
    sources = (EntityKind.TASK, EntityKind.ISR, EntityKind.STIMULUS)
    return assumed in sources and kind in sources


# From the rows of a file to tables of events.

#: The largest number in a column.
MAX = 2**63 - 1
#: So many lines are read at a time.
BLOCK = 1 << 13

#: What the lines with the same words have in common: kind of event, source, target.
Pattern: TypeAlias = tuple[EventKind, int, int]
#: Time, number of the pattern, source instance, target instance, note.
Row: TypeAlias = Sequence[int]


def table_of(rows: Sequence[Row], patterns: Sequence[Pattern], index: EntityIndex, scale: int = 1) -> EventTable:
    """The table of some rows.

    Parameters
    ----------
    scale : picoseconds of the unit of time
    """
    time, pattern, source_instance, target_instance, note = np.array(rows, np.int64).T.copy()
    kind, source, target = np.array(patterns, np.int32)[pattern].T.copy()
    # Before BTF 2.2, what has no instances has the number -1, and so has the simulation as source of a stimulus.
    target_instance = np.maximum(target_instance, 0)
    source_instance = np.where(source_instance < 0, np.where(source == target, target_instance, 0), source_instance)
    kinds = kind.astype(np.int16)
    return EventTable(index.entities, time * scale, kinds, source, source_instance, target, target_instance, note)


def note_of(text: str, kind: EventKind, index: EntityIndex, name: str) -> int:
    """The note of an event: a whole number, or of an OS event the index of its owner, whose name that is."""
    if not text:
        return NO_NOTE
    if kind in OS_EVENTS:
        return index.source_index(name, PROCESSES)
    try:
        note = int(text)
    except ValueError:  # values of other types have no place in the table
        return NO_NOTE
    return note if abs(note) <= MAX else NO_NOTE


class TraceReader(ABC):
    """Gives the events of a trace; it can be used once.

    Attributes
    ----------
    begin_of_chains : whether chains begin with the activation of the job that makes their first step, or with that step
    """

    begin_of_chains: ClassVar[EventKind] = EventKind.ACTIVATE

    def __init__(self, path: Path) -> None:
        self._path = path
        self._problems = TraceProblems(path)
        self._index = EntityIndex()

    @property
    def entities(self) -> Sequence[Entity]:
        """The entities so far; complete when all events have been read."""
        return self._index.entities

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The problems met so far; everything else has been read."""
        return self._problems.findings

    @abstractmethod
    def __iter__(self) -> Iterator[EventTable]:
        """The events, in consecutive tables."""


class LineReader(TraceReader):
    """Gives the events of a file with an event in each line."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self._patterns: list[Pattern] = []
        self._last = 0
        self._gap: int | None = None

    def _gap_row(self, time: int) -> Row:
        """The place of a line that cannot be used: nobody knows which event is missing."""
        if self._gap is None:
            recorder = self._index.index(EntityKind.SCHEDULER, "recorder")
            self._gap = len(self._patterns)
            self._patterns.append((EventKind.GAP, recorder, recorder))
        return time, self._gap, 0, 0, NO_NOTE


# The rows of a trace that a reader makes, and the order of their times.

#: Times above it do not count from the start of the controller: as picoseconds since 1970 they exceed 64 bits.
_LONGEST_UPTIME = MAX // 2


class EventRows:
    """Collects events in the order of time.

    Times are those of the recording. If its first one is negative, or so large that it is a date, the first event is at 0.

    Attributes
    ----------
    time : of the events that are added, in picoseconds
    """

    def __init__(self, index: EntityIndex, problems: TraceProblems) -> None:
        self.index = index
        self.time = 0
        self._problems = problems
        self._origin: int | None = None
        self._patterns: list[Pattern] = []
        self._numbers: dict[Pattern, int] = {}
        self._rows: list[list[int]] = []
        self._last: list[int] | None = None
        self._gap: list[int] | None = None

    def __len__(self) -> int:
        return len(self._rows)

    def move_to(self, time: int, place: TracePlace) -> bool:
        """Whether events can be at a time, which is then that of the next ones; if not, that is a problem.

        Parameters
        ----------
        time : picoseconds of the recording
        """
        if self._origin is None:
            self._origin = 0 if 0 <= time <= _LONGEST_UPTIME else time
        time -= self._origin
        if not self.time <= time <= MAX:
            is_earlier = time < self.time
            message = "the time is less than that of an event before" if is_earlier else "the time is too large"
            self._problems.add("TRC004", Severity.ERROR, f"{message}; this event is ignored", place)
            return False
        self.time = time
        return True

    def add(
        self, kind: EventKind, source: int, source_instance: int, target: int, instance: int, note: int = NO_NOTE
    ) -> list[int]:
        """Add an event at the present time; its row can be changed until it is taken."""
        row = [self.time, self._pattern(kind, source, target), source_instance, instance, note]
        self._rows.append(row)
        self._last = row
        return row

    def add_gap(self, lost: int = NO_NOTE) -> None:
        """Add the place of a loss of events of all sources, once where several are lost; before the first event nothing can be.

        Parameters
        ----------
        lost : number of events
        """
        if self._origin is None or (lost == NO_NOTE and self._gap is not None and self._gap is self._last):
            return
        recorder = self.index.index(EntityKind.SCHEDULER, "recorder")
        # A damaged file can claim to have lost any number.
        self._gap = self.add(EventKind.GAP, recorder, 0, recorder, 0, min(lost, MAX))

    def change_kind(self, row: list[int], kind: EventKind) -> None:
        """Let an event that has not been taken be one of another kind."""
        _, source, target = self._patterns[row[1]]
        row[1] = self._pattern(kind, source, target)

    def before(self, rows: list[list[int]]) -> int:
        """How many rows are before all of certain ones."""
        numbers = set(map(id, rows))
        return next((number for number, row in enumerate(self._rows) if id(row) in numbers), len(self._rows))

    def take(self, number: int) -> EventTable | None:
        """The first events, which are no longer kept; None if there are none."""
        rows, self._rows = self._rows[:number], self._rows[number:]
        return table_of(rows, self._patterns, self.index) if rows else None

    def _pattern(self, kind: EventKind, source: int, target: int) -> int:
        pattern = kind, source, target
        number = self._numbers.get(pattern)
        if number is None:
            number = self._numbers[pattern] = len(self._patterns)
            self._patterns.append(pattern)
        return number
