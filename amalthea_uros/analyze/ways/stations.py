"""What a chain passes: messages on wires, callbacks of executors that loop, and other processes, in order."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from amalthea_uros.perf.activities import Call
from amalthea_uros.perf.events import CustomEvent, Event, EventChain
from amalthea_uros.perf.executors import Executor, Handle
from amalthea_uros.perf.network import Transmission
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow.chains import UnfoldError, sequences, unfold
from amalthea_uros.timing.dataflow.events import EventOccurrence, UnresolvedError
from amalthea_uros.timing.jobs.positions import ActivityPosition


class UnknownWayError(Exception):
    """The hops of a chain cannot be told; the text says why."""


@dataclass(frozen=True, slots=True)
class Message:
    """A message on a wire."""

    transmission: Transmission


@dataclass(frozen=True, slots=True)
class Callback:
    """A callback of an executor that loops."""

    executor: Executor
    handle: Handle


@dataclass(frozen=True, slots=True)
class Passage:
    """Events of other processes, which follow each other."""

    events: tuple[Event, ...]
    processes: tuple[str, ...]


Station: TypeAlias = Message | Callback | Passage


def stations_of(chain: EventChain, context: TimingContext) -> list[Station]:
    """The stations of a chain, in order; events that follow each other in one place are one station.

    Raises
    ------
    UnknownWayError : it has branches, or one of its events has no place of its own.
    """
    try:
        ways = sequences(unfold(chain, context.system)[0])
    except UnfoldError as error:
        raise UnknownWayError(str(error)) from None
    if len(ways) != 1:
        raise UnknownWayError("it has parallel paths, whose latency over wires and executors is not computed; split the chain")
    found: list[Station] = []
    for name in ways[0]:
        station = _station(context.system.events_by_name[name], found[-1] if found else None, context)
        if isinstance(station, Passage) and found and isinstance(found[-1], Passage):
            before = found.pop()
            assert isinstance(before, Passage)
            station = Passage((*before.events, *station.events), (*before.processes, *station.processes))
        if not found or found[-1] != station:
            found.append(station)
    return found


def _no_place(event: Event, error: UnresolvedError) -> str:
    if isinstance(event, CustomEvent):
        return f"{event.name!r} occurs outside the model: describe 'transport' and 'agent' of the middleware"
    return str(error)


def _station(event: Event, before: Station | None, context: TimingContext) -> Station:
    """Where an event occurs; if that can be in several places, the station before it if it is one of these."""
    try:
        occurrences = context.dataflow.events.of(event)
    except UnresolvedError as error:
        raise UnknownWayError(_no_place(event, error)) from None
    found = {_station_at(event, occurrence, context) for occurrence in occurrences}
    if before in found:
        return before
    if len(found) != 1:
        raise UnknownWayError(f"the event {event.name!r} can occur in several places; set its process")
    return found.pop()


def _station_at(event: Event, occurrence: EventOccurrence, context: TimingContext) -> Station:
    system, process = context.system, occurrence.process.name
    if process in system.transmissions:
        return Message(system.transmissions[process])
    executor = system.executor_of_task.get(process)
    if executor is None:
        return Passage((event,), (process,))
    position = occurrence.position
    handle = handle_around(position, executor, context) if position is not None else None
    if handle is None:
        raise UnknownWayError(
            f"the event {event.name!r} is one of a whole round of {executor.name!r}; name a callback or a topic"
        )
    return Callback(executor, handle)


def handle_around(position: ActivityPosition, executor: Executor, context: TimingContext) -> Handle | None:
    """The handle whose callback, or whose taking of a message, an activity is part of."""
    handles = {handle.runnable: handle for handle in executor.handles}
    handles |= {handle.take: handle for handle in executor.handles if handle.take is not None}
    around = [
        handles[each.activity.runnable]
        for each in context.dataflow.events.positions(executor.task)
        if isinstance(each.activity, Call) and each.activity.runnable in handles and each.number <= position.number <= each.last
    ]
    return around[-1] if around else None


def name_of(station: Station, *, is_end: bool = False) -> str:
    """What people call a station: its topic, its callback, its first or its last process."""
    match station:
        case Message(transmission):
            topic = transmission.topic
            return transmission.name if topic is None else f"/{topic.removeprefix('/')}"
        case Callback(_, handle):
            return handle.name
        case Passage(_, processes):
            return processes[-1 if is_end else 0]
