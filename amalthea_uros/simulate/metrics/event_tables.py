"""When the events occur that constraints refer to, from the rows about occurrences at their sources."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.perf.events import Event, EventSet, ProcessChange, ProcessEvent, RunnableEvent, SemaphoreEvent
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.program.watches import Source, is_source
from amalthea_uros.simulate.rows import Observation

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Numbers = NDArray[np.int64]
    Flags = NDArray[np.bool_]


@dataclass(slots=True)
class SourceTable:
    """Which rows are occurrences of something: those of some sources, of some of them on one core only."""

    sources: Flags
    core: int = -1
    off_core: Flags | None = None

    def places(self, rows: Numbers) -> Numbers:
        """The indices of the rows."""
        numbers = rows[:, Observation.ROUTE]
        is_found = self.sources[numbers]
        if self.off_core is not None:
            is_found &= (rows[:, Observation.STAMP] == self.core) | self.off_core[numbers]
        return np.flatnonzero(is_found)


@dataclass(slots=True)
class _SetTable:
    """An event set: it occurs when all its events have occurred since it occurred last."""

    members: list[EventTable]
    _seen: set[int] = field(default_factory=set)

    def places(self, rows: Numbers) -> Numbers:
        """The indices of the rows that complete the set."""
        found = [member.places(rows) for member in self.members]
        places, which = in_order(found)
        completed: list[int] = []
        for place, member in zip(places.tolist(), which.tolist(), strict=True):
            self._seen.add(member)
            if len(self._seen) == len(self.members):
                self._seen.clear()
                completed.append(place)
        return np.array(completed, np.int64)


#: Which rows are occurrences of an event.
EventTable = SourceTable | _SetTable


@dataclass(slots=True)
class EventTables:
    """The events of a system, and the sources at which they occur in a program."""

    system: System
    sources: Sequence[Source]
    cores: Sequence[str]

    def table(self, name: str) -> EventTable | None:
        """Which rows are occurrences of an event; None if it occurs nowhere."""
        event = self.system.events_by_name.get(name)
        if isinstance(event, EventSet):
            members = [self.table(each) for each in dict.fromkeys(event.events) if each != name]
            found = [member for member in members if member is not None]
            return _SetTable(found) if found and len(found) == len(members) else None
        return None if event is None else self._of_sources(event)

    def _of_sources(self, event: Event) -> SourceTable | None:
        found = np.array([is_source(source, event) for source in self.sources], bool)
        if not found.any():
            return None
        core = event.core if isinstance(event, ProcessEvent | RunnableEvent | SemaphoreEvent) else None
        if core is None:
            return SourceTable(found)
        # An activation is on no core.
        off_core = np.array([source.change is ProcessChange.ACTIVATE for source in self.sources], bool)
        return SourceTable(found, self.cores.index(core) if core in self.cores else -2, off_core)


def in_order(places: Iterable[Numbers]) -> tuple[Numbers, Numbers]:
    """Several ascending lists as one, and for each entry the number of its list; at the same place the first list comes first."""
    lists = list(places)
    together = np.concatenate([np.empty(0, np.int64), *lists])
    which = np.repeat(np.arange(len(lists)), [len(each) for each in lists])
    order = np.argsort(together, kind="stable")
    return together[order], which[order]
