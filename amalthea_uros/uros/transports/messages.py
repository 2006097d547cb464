"""The messages of an application on their way: what the middleware makes of them, how long senders wait, and what drivers cost."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.executors import HandleKind, Publication
from amalthea_uros.perf.network import Direction, Wait
from amalthea_uros.perf.system import System
from amalthea_uros.spec.execution_time import ExecutionTimeSection
from amalthea_uros.spec.transports import Driver
from amalthea_uros.units import Time
from amalthea_uros.uros.application.callbacks import Callback, body_name
from amalthea_uros.uros.application.messages import Message, MessageKind
from amalthea_uros.uros.middleware.profile import MessagePart, Profile
from amalthea_uros.uros.transports.framing import least_frame, longest_frame, reads
from amalthea_uros.uros.transports.line import Line, describes_wire, time_on


@dataclass(frozen=True, slots=True, kw_only=True)
class WireMessage:
    """A message with what is sent for it."""

    message: Message
    callback: Callback
    parts: tuple[MessagePart, ...]

    @property
    def name(self) -> str:
        """The name of its task."""
        return self.message.transmission

    @property
    def direction(self) -> Direction:
        """Whether it arrives or leaves."""
        return self.message.direction

    @property
    def jitter(self) -> Time:
        """Maximum delay against its nominal time, of one that arrives."""
        return self.callback.jitter if self.message.is_incoming else 0

    @property
    def interval(self) -> Time:
        """Minimum time between two of them, before `jitter`."""
        return self.message.interval + self.jitter

    @property
    def length(self) -> int:
        """In bytes, with the headers of the middleware."""
        return sum(part.length for part in self.parts)

    @property
    def is_acknowledged(self) -> bool:
        """Whether the receiver answers to a part of it."""
        return any(part.acknowledgement is not None for part in self.parts)


def wire_messages(callbacks: Iterable[Callback], profile: Profile) -> Iterator[WireMessage]:
    """All messages that callbacks receive and send."""
    for callback in callbacks:
        for message in (*([callback.incoming] if callback.incoming else []), *callback.outgoing):
            parts = profile.parts(message.kind, message.content_bytes, reliable=message.reliable)
            yield WireMessage(message=message, callback=callback, parts=tuple(parts))


def opposite(direction: Direction) -> Direction:
    """The direction of acknowledgements."""
    return Direction.TO_AGENT if direction is Direction.TO_CONTROLLER else Direction.TO_CONTROLLER


def acknowledgement_name(transmission: str) -> str:
    """The name of the task of the acknowledgements of a message."""
    return f"{transmission}_acknowledgement"


# What a callback sends, and how long it waits for the acknowledgement


def publications(callback: Callback, profile: Profile) -> Iterator[Publication]:
    """The messages that a callback sends, in their order: to topics, requests, then its response."""
    if callback.kind in (HandleKind.PARAMETER_SERVICE, HandleKind.LIFECYCLE_SERVICE):
        yield from _of_middleware(callback, profile)
        return
    for each in wire_messages([callback], profile):
        message = each.message
        if message.is_incoming:
            continue
        timeout = message.timeout
        if timeout is None:
            timeout = profile.times_out_after(message.kind, message.content_bytes, reliable=message.reliable)
        transmission = each.name if describes_wire(profile.middleware.transport) else None
        yield Publication(
            topic=message.sent_as,
            transmission=transmission,
            reliable=message.reliable,
            acknowledgement=acknowledgement_name(transmission) if transmission and each.is_acknowledged else None,
            waits=timeout is not None,
            timeout=timeout,
            attempts=message.attempts,
        )


def _of_middleware(callback: Callback, profile: Profile) -> Iterator[Publication]:
    """Responses of parameters and of the lifecycle: of unknown sizes, but reliable, so that they keep the executor as others do."""
    timeout = profile.times_out_after(MessageKind.RESPONSE_OUT, 0, reliable=True)
    topics = [f"{callback.name} (response)"]
    server = callback.node.parameter_server if callback.kind is HandleKind.PARAMETER_SERVICE else None
    if server is not None and server.events:
        topics.append("parameter_events")
    for topic in topics:
        yield Publication(topic=topic, reliable=True, waits=timeout is not None, timeout=timeout)


def waits_outside(callbacks: Iterable[Callback], system: System, profile: Profile) -> Iterator[Wait]:
    """The waits of callbacks that no executor in a loop runs, for acknowledgements of messages that no wire of the system has.

    In executors that spin in loops, publications say so themselves; messages on wires of the system, too.

    Parameters
    ----------
    system : with its executors and its wires
    """
    loops = {executor.name for executor in system.executors}
    wired = {transmission.name for transmission in system.network.transmissions if transmission.waits}
    for callback in callbacks:
        if callback.in_executor and callback.executor in loops:
            continue
        for each in publications(callback, profile):
            if each.waits and each.transmission not in wired:
                yield Wait(runnable=body_name(callback.name), topic=each.topic, timeout=each.timeout)


# Execution time of the calls of the driver, which is part of what sends or receives a message


def driver_costs(
    line: Line | None, callback: Callback, direction: Direction, profile: Profile
) -> Iterator[ExecutionTimeSection | Time]:
    """The parts of the execution time that the driver needs for the messages of a callback in a direction, and their acknowledgements.

    They are those of its calls, and of copying bytes if it polls.
    """
    if line is None or line.driver is None:
        return
    messages = wire_messages([callback], profile)
    for part in (part for message in messages if message.direction is direction for part in message.parts):
        yield from _of_part(part.length, direction, line, line.driver)
        if part.acknowledgement is not None:
            yield from _of_part(part.acknowledgement, opposite(direction), line, line.driver)


def _of_part(length: int, direction: Direction, line: Line, driver: Driver) -> Iterator[ExecutionTimeSection | Time]:
    """The parts for a message of the middleware; escaped bytes need more calls and time."""
    cost = driver.write_cost if direction is Direction.TO_AGENT else driver.read_cost
    sizes = (least_frame(length), longest_frame(length)) if line.is_framed else (length, length)
    if cost.fixed is not None:
        least, most = _calls(sizes, direction, line, length)
        yield from [cost.fixed] * least
        yield from [_between(0, cost.fixed.max) if cost.fixed.max is not None else cost.fixed] * (most - least)
    if cost.per_byte:
        yield _between(cost.per_byte * sizes[0], cost.per_byte * sizes[1])
    if (driver.write if direction is Direction.TO_AGENT else driver.read) == "polling":
        # The bytes are copied while they are on the line, which has its own time: in the best case, nothing comes on top of that.
        yield _between(0, time_on(line, line.frames(length, direction))[1])


def _between(least: Time, most: Time) -> ExecutionTimeSection | Time:
    return most if least == most else ExecutionTimeSection.model_construct(min=least, max=most)


def _calls(sizes: tuple[int, int], direction: Direction, line: Line, length: int) -> tuple[int, int]:
    """The least and the most calls for a frame."""
    if direction is Direction.TO_AGENT:
        frames = line.frames(length, direction)
        return sum(frame.least > 0 for frame in frames), len(frames)
    return (reads(sizes[0])[0], reads(sizes[1])[1]) if line.is_framed else (1, 1)
