"""What takes the effect from one station of a chain to the next one."""

from __future__ import annotations

from dataclasses import dataclass

from amalthea_uros.analyze.ways.passages import Entry
from amalthea_uros.analyze.ways.stations import Callback, Passage, Station, UnknownWayError, handle_around, name_of
from amalthea_uros.perf.events import RunnableChange, RunnableEvent
from amalthea_uros.perf.network import Transmission
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow.events import EventOccurrence
from amalthea_uros.timing.dataflow.links import LinkKind
from amalthea_uros.timing.jobs.positions import ActivityPosition


@dataclass(frozen=True, slots=True)
class Connections:
    """Finds the data and triggers between the callbacks of executors and other processes."""

    context: TimingContext

    def entry(self, first: Callback | Passage, then: Callback | Passage) -> Entry:
        """How the effect gets from one station to the next.

        Raises
        ------
        UnknownWayError : nothing connects them, or nobody knows how long it takes.
        """
        if isinstance(then, Passage) and self.activates(first, then.processes[0]):
            return Entry.TRIGGER
        found = {
            link.kind
            for one in self._ends(first, -1)
            for other in self._ends(then, 0)
            for link in self.context.dataflow.data(one, other)
            if self._is_within(link.write, first) and self._is_within(link.read, then)
        }
        if LinkKind.DATA in found:
            return Entry.DATA
        if LinkKind.TOPIC in found:
            raise UnknownWayError(
                f"a message takes the effect from {name_of(first)!r} to {name_of(then)!r} over the agent; add its topic to the path"
            )
        raise UnknownWayError(f"no data flow or trigger connects {name_of(first)!r} to {name_of(then)!r}")

    def is_activated_after(self, transmission: Transmission, process: str) -> bool:
        """Whether the last process that a message passes activates another one."""
        last = transmission.processes[-1:]
        return any(self.context.dataflow.triggers(each, process) for each in last)

    def activates(self, first: Callback | Passage, process: str) -> bool:
        """Whether a callback, or the last process of a passage, activates another process."""
        source = first.executor.task if isinstance(first, Callback) else first.processes[-1]
        return any(self._is_within(link.write, first) for link in self.context.dataflow.triggers(source, process))

    def _ends(self, station: Callback | Passage, index: int) -> list[EventOccurrence]:
        """Where the last or the first event of a station occurs."""
        if isinstance(station, Passage):
            return self.context.dataflow.events.of(station.events[index])
        handle = station.handle
        names = [name for name in (handle.runnable, handle.take) if name is not None]
        events = [
            RunnableEvent(name=name, runnable=name, change=RunnableChange.TERMINATE, process=station.executor.task)
            for name in names
        ]
        return [occurrence for event in events for occurrence in self.context.dataflow.events.of(event)]

    def _is_within(self, position: ActivityPosition | None, station: Station) -> bool:
        """Whether an activity is part of a callback; for other processes it is one of their jobs."""
        if not isinstance(station, Callback) or position is None:
            return True
        return handle_around(position, station.executor, self.context) == station.handle
