"""The rows of a trace that a reader makes, and the order of their times."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.entity_index import EntityIndex
from amalthea_uros.trace.problems import Place, Problems
from amalthea_uros.trace.row_tables import MAX, NumberedTable, Pattern, numbered_table
from amalthea_uros.trace.table import NO_NOTE, EntityKind, EventKind

#: Times above it do not count from the start of the controller: as picoseconds since 1970 they exceed 64 bits.
_LONGEST_UPTIME = MAX // 2


class EventRows:
    """Collects events in the order of time.

    Times are those of the recording. If its first one is negative, or so large that it is a date, the first event is at 0.

    Attributes
    ----------
    time : of the events that are added, in picoseconds
    """

    def __init__(self, index: EntityIndex, problems: Problems) -> None:
        self.index = index
        self.time = 0
        self._problems = problems
        self._line = 0
        self._origin: int | None = None
        self._patterns: list[Pattern] = []
        self._numbers: dict[Pattern, int] = {}
        self._rows: list[list[int]] = []
        self._last: list[int] | None = None
        self._gap: list[int] | None = None

    def __len__(self) -> int:
        return len(self._rows)

    def move_to(self, time: int, line: int, place: Place) -> bool:
        """Whether events can be at a time, which is then that of the next ones; if not, that is a problem.

        Parameters
        ----------
        time : picoseconds of the recording
        line : number of the line or of the event in the file
        """
        if self._origin is None:
            self._origin = 0 if 0 <= time <= _LONGEST_UPTIME else time
        time -= self._origin
        if not self.time <= time <= MAX:
            is_earlier = time < self.time
            message = "the time is less than that of an event before" if is_earlier else "the time is too large"
            self._problems.add("TRC004", Severity.ERROR, f"{message}; this event is ignored", place)
            return False
        self.time, self._line = time, line
        return True

    def add(
        self, kind: EventKind, source: int, source_instance: int, target: int, instance: int, note: int = NO_NOTE
    ) -> list[int]:
        """Add an event at the present time; its row can be changed until it is taken."""
        row = [self.time, self._pattern(kind, source, target), source_instance, instance, note, self._line]
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
        self._gap = self.add(EventKind.GAP, recorder, 0, recorder, 0, lost)

    def change_kind(self, row: list[int], kind: EventKind) -> None:
        """Let an event that has not been taken be one of another kind."""
        _, source, target = self._patterns[row[1]]
        row[1] = self._pattern(kind, source, target)

    def before(self, rows: list[list[int]]) -> int:
        """How many rows are before all of certain ones."""
        numbers = set(map(id, rows))
        return next((number for number, row in enumerate(self._rows) if id(row) in numbers), len(self._rows))

    def take(self, number: int) -> NumberedTable | None:
        """The first events, which are no longer kept; None if there are none."""
        rows, self._rows = self._rows[:number], self._rows[number:]
        return numbered_table([tuple(row) for row in rows], self._patterns, self.index, scale=1) if rows else None  # type: ignore[misc]

    def _pattern(self, kind: EventKind, source: int, target: int) -> int:
        pattern = kind, source, target
        number = self._numbers.get(pattern)
        if number is None:
            number = self._numbers[pattern] = len(self._patterns)
            self._patterns.append(pattern)
        return number
