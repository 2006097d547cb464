"""What a chain passes: messages on wires, callbacks of executors in loops, and other processes, in order, and what connects them."""

from __future__ import annotations

from enum import Enum
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.results import HopKind
from amalthea_uros.executors.semantics.callbacks import handle_around, taker
from amalthea_uros.perf.events import CustomEvent, Event, EventChain, RunnableChange, RunnableEvent
from amalthea_uros.perf.executors import Executor, Handle
from amalthea_uros.perf.host import HostCallback
from amalthea_uros.perf.network import Transmission
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow.chains import sequences, unfold
from amalthea_uros.timing.dataflow.events import EventOccurrence
from amalthea_uros.timing.dataflow.links import LinkKind
from amalthea_uros.timing.jobs.positions import ActivityPosition


@dataclass(frozen=True, slots=True)
class CallbackSegment:
    """A callback of an executor in a loop."""

    executor: Executor
    handle: Handle


@dataclass(frozen=True, slots=True)
class TaskSegment:
    """Events of other processes, which follow each other."""

    events: tuple[Event, ...]
    processes: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class HostSegment:
    """Callbacks of the host, which follow each other."""

    callbacks: tuple[HostCallback, ...]


#: A message on a wire is a segment by itself.
ChainSegment: TypeAlias = Transmission | CallbackSegment | TaskSegment | HostSegment


class EntryKind(Enum):
    """How a message or data get to a process."""

    FIRST = "the chain starts here"
    TRIGGER = "it is activated"
    DATA = "it reads data at its own times"
    POLLING = "it looks for messages in each job"

    @property
    def hop(self) -> HopKind:
        """The kind of the hop from there on."""
        return {EntryKind.POLLING: HopKind.POLLING, EntryKind.DATA: HopKind.SAMPLING}.get(self, HopKind.TASKS)


def name_of(segment: ChainSegment, *, is_end: bool = False) -> str:
    """What people call a segment: its topic, its callback, its first or its last process."""
    match segment:
        case Transmission(name=name, topic=topic):
            return name if topic is None else f"/{topic.removeprefix('/')}"
        case CallbackSegment(_, handle):
            return handle.name
        case TaskSegment(_, processes):
            return processes[-1 if is_end else 0]
        case HostSegment(callbacks):
            return callbacks[-1 if is_end else 0].name


@dataclass(frozen=True, slots=True)
class Segments:
    """Finds the segments of chains, and the data and triggers between them."""

    context: TimingContext

    def of(self, chain: EventChain) -> list[ChainSegment]:
        """The segments of a chain, in order; events that follow each other in one place are one segment.

        Raises
        ------
        UnknownError : it has branches, or one of its events has no place of its own.
        """
        paths = sequences(unfold(chain, self.context.system)[0])
        if len(paths) != 1:
            raise UnknownError("it has parallel paths, whose latency over wires and executors is not computed; split the chain")
        segments: list[ChainSegment] = []
        for name in paths[0]:
            before = segments[-1] if segments else None
            segment = self._segment(self.context.system.events_by_name[name], before)
            if isinstance(segment, TaskSegment) and isinstance(before, TaskSegment):
                segments[-1] = TaskSegment((*before.events, *segment.events), (*before.processes, *segment.processes))
            elif isinstance(segment, HostSegment) and isinstance(before, HostSegment):
                segments[-1] = HostSegment(tuple(dict.fromkeys((*before.callbacks, *segment.callbacks))))
            elif segment != before:
                segments.append(segment)
        return self._with_takers(segments)

    def _segment(self, event: Event, before: ChainSegment | None) -> ChainSegment:
        """Where an event occurs; if that can be in several places, the segment before it if it is one of these."""
        if (
            isinstance(event, CustomEvent)
            and (callback := self.context.system.callback_of_host_event.get(event.name)) is not None
        ):
            return HostSegment((callback,))
        try:
            occurrences = self.context.dataflow.events.of(event)
        except UnknownError as error:
            raise UnknownError(str(error)) from None
        possible = {self._at(event, occurrence) for occurrence in occurrences}
        if before in possible:
            return before
        if len(possible) != 1:
            raise UnknownError(f"the event {event.name!r} can occur in several places; set its process")
        return possible.pop()

    def _at(self, event: Event, occurrence: EventOccurrence) -> ChainSegment:
        system, process = self.context.system, occurrence.process.name
        if process in system.transmissions:
            return system.transmissions[process]
        executor = system.executor_of_task.get(process)
        if executor is None:
            return TaskSegment((event,), (process,))
        handle = (
            None if occurrence.position is None else handle_around(occurrence.position, executor, self.context.dataflow.events)
        )
        if handle is None:
            raise UnknownError(
                f"the event {event.name!r} is one of a whole iteration of {executor.name!r}; name a callback or a topic"
            )
        return CallbackSegment(executor, handle)

    def _with_takers(self, segments: list[ChainSegment]) -> list[ChainSegment]:
        """The segments with the callbacks that only take messages for others, without what a message passes by itself."""
        completed: list[ChainSegment] = []
        for segment in segments:
            before = completed[-1] if completed else None
            if not isinstance(segment, TaskSegment) or not isinstance(before, Transmission):
                completed.append(segment)
                continue
            passed = before.processes
            kept = [each for each in zip(segment.events, segment.processes, strict=True) if each[1] not in passed]
            if kept:
                ready = taker(before, self.context.system)
                completed += [] if ready is None else [CallbackSegment(*ready)]
                completed.append(TaskSegment(tuple(event for event, _ in kept), tuple(process for _, process in kept)))
        return completed

    def entry(self, before: ChainSegment | None, segment: CallbackSegment | TaskSegment) -> EntryKind:
        """How the effect gets from one segment to the next, which no message makes ready.

        Raises
        ------
        UnknownError : nothing connects them, or nobody knows how long it takes.
        """
        if before is None:
            return EntryKind.FIRST
        if isinstance(before, HostSegment):
            raise UnknownError(
                f"a message takes the effect from {name_of(before, is_end=True)!r} over the agent; add its topic to the path"
            )
        if isinstance(segment, TaskSegment):
            if isinstance(before, Transmission):
                # The last process that it passes may activate the next one.
                last = before.processes[-1:]
                is_activated = any(self.context.dataflow.triggers(each, segment.processes[0]) for each in last)
                return EntryKind.TRIGGER if is_activated else EntryKind.POLLING
            if self.activates(before, segment.processes[0]):
                return EntryKind.TRIGGER
        assert not isinstance(before, Transmission)
        kinds = {
            link.kind
            for one in self._ends(before, -1)
            for other in self._ends(segment, 0)
            for link in self.context.dataflow.data(one, other)
            if self._is_within(link.write, before) and self._is_within(link.read, segment)
        }
        if LinkKind.DATA in kinds:
            return EntryKind.DATA
        first, then = name_of(before), name_of(segment)
        if LinkKind.MESSAGE in kinds:
            raise UnknownError(
                f"a message takes the effect from {first!r} to {then!r} over the agent; add its topic to the path"
            )
        raise UnknownError(f"no data flow or trigger connects {first!r} to {then!r}")

    def activates(self, segment: CallbackSegment | TaskSegment, process: str) -> bool:
        """Whether a callback, or the last process of a segment, activates another process."""
        source = segment.executor.task if isinstance(segment, CallbackSegment) else segment.processes[-1]
        return any(self._is_within(link.write, segment) for link in self.context.dataflow.triggers(source, process))

    def _ends(self, segment: CallbackSegment | TaskSegment, index: int) -> list[EventOccurrence]:
        """Where the last or the first event of a segment occurs."""
        locate = self.context.dataflow.events.of
        if isinstance(segment, TaskSegment):
            return locate(segment.events[index])
        names = [name for name in (segment.handle.runnable, segment.handle.take) if name is not None]
        task, change = segment.executor.task, RunnableChange.TERMINATE
        events = [RunnableEvent(name=name, runnable=name, change=change, process=task) for name in names]
        return [occurrence for event in events for occurrence in locate(event)]

    def _is_within(self, position: ActivityPosition | None, segment: ChainSegment) -> bool:
        """Whether an activity is part of a callback; for other processes it is one of their jobs."""
        if not isinstance(segment, CallbackSegment) or position is None:
            return True
        return handle_around(position, segment.executor, self.context.dataflow.events) == segment.handle
