"""How long reliable messages to the controller wait for one before them that is missing, and what the agent sends again.

The client hands over reliable messages in their order, and answers each message and each heartbeat of the agent; as long as the
answer says that something is missing, the agent sends that again (eProsima/Micro-XRCE-DDS-Agent `OutputStream.hpp`, `Processor.cpp`;
`input_reliable_stream.c` of the client). docs/proofs/missing-messages.md proves the bounds. Let n be the most messages that are lost
in the stated time, G the greatest distance of what the agent sends reliably, its heartbeats included, and T the longest time from when
it sends that until it sends again what the answer asks for. Of n such attempts after a loss, one at least is hit by no other loss, so
that a message waits for at most

    n G + T

besides its own time on the wire. Meanwhile the client has to keep everything that came after the missing one.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.bounds.backlog import MAX_BACKLOG
from amalthea_uros.executors.bounds.cycle import Cycle
from amalthea_uros.executors.bounds.solved_system import SolvedSystem
from amalthea_uros.executors.bounds.transmissions import agent_hop, received, sent
from amalthea_uros.executors.results import Hop
from amalthea_uros.executors.semantics.losses import answer_to, reliable_messages, why_unbounded
from amalthea_uros.executors.semantics.readiness import arrivals, reads_in_waits
from amalthea_uros.perf.executors import Handle
from amalthea_uros.perf.network import Direction, Purpose, Span, Transmission, Wire
from amalthea_uros.timing.activation.relays import comes_regularly
from amalthea_uros.timing.event_models.derived import Multiplied
from amalthea_uros.timing.event_models.models import EventModel, PeriodicEvents, SporadicEvents
from amalthea_uros.units import Rounding, Time, rounded_time_text, time_text

_ASSUMPTION = "executors: periodic messages keep coming, as a missing reliable message is found with the next one"


@dataclass(frozen=True, slots=True, kw_only=True)
class MissingMessages:
    """The effects of losses on reliable messages to the controller.

    Attributes
    ----------
    wait : the longest time for which a message waits for missing ones
    again : what is sent again, and what is read before a missing one, of all messages together; None if none can be missing
    """

    wait: Time
    again: EventModel | None


@dataclass(frozen=True, slots=True, kw_only=True)
class _Attempts:
    """How the agent sends again what is missing.

    Attributes
    ----------
    messages : when the agent sends each reliable message
    asks_every : distance of its heartbeats
    distance : greatest distance of what it sends reliably, heartbeats included
    trip : longest time from when it sends something until it sends again what the answer to that asks for
    reading : longest time from when it sends something until that is read
    """

    messages: Sequence[PeriodicEvents]
    asks_every: Time
    distance: Time
    trip: Time
    reading: Time

    def sent_in(self, window: Time) -> int:
        """The most reliable messages in a time, without what is sent again."""
        return sum(each.eta_plus(window + 1) for each in self.messages)


def missing_messages(solved: SolvedSystem, sending: Mapping[str, Span]) -> Mapping[str, MissingMessages | str]:
    """The effects of losses, by the names of reliable messages to the controller; or why they have no bound."""
    system = solved.context.system
    effects: dict[str, MissingMessages | str] = {}
    for wire in system.network.wires:
        messages = reliable_messages(wire.name, Direction.TO_CONTROLLER, system)
        if wire.losses and messages and not why_unbounded(wire, system):
            effects |= dict.fromkeys((each.name for each in messages), _on(wire, messages, solved, sending))
    return effects


def waits_for_missing(missing: Mapping[str, MissingMessages | str]) -> dict[str, Time | None]:
    """How long reliable messages can wait for missing ones, by the names of transmissions; None if that has no bound."""
    return {name: None if isinstance(each, str) else each.wait for name, each in missing.items()}


def _on(
    wire: Wire, messages: Sequence[Transmission], solved: SolvedSystem, sending: Mapping[str, Span]
) -> MissingMessages | str:
    reader = next(each for each in solved.context.system.executors if reads_in_waits(each))
    try:
        attempts = _attempts(wire, messages, Cycle.of(reader, solved, sending))
    except UnknownError as error:
        return str(error)
    lost, window = sum(each.count for each in wire.losses), min(each.window for each in wire.losses)
    wait = lost * attempts.distance + attempts.trip
    acknowledged = (lost + 1) * attempts.distance + 2 * attempts.trip
    can_be_missing = any(Direction.TO_CONTROLLER in each.directions for each in wire.losses)
    if lost * acknowledged >= window:
        limit = rounded_time_text(acknowledged, Rounding.UP)
        return (
            f"{counted(lost, 'message')} can be lost in {time_text(window)}, and after each of them "
            f"it can take {limit} until what is missing has been sent again"
        )
    recovery = wire.recovery
    assert recovery is not None
    for time, room, keeper in (
        (wait + attempts.reading if can_be_missing else 0, recovery.received_parts, "the client"),
        (acknowledged, recovery.agent_sent_parts, "the agent"),
    ):
        if room is not None and attempts.sent_in(time) > room:
            return (
                f"until a missing message is there, up to {attempts.sent_in(time)} reliable ones can follow, "
                f"and {keeper} keeps {room}"
            )
    return _lossy(attempts, lost, window, wait, acknowledged) if can_be_missing else MissingMessages(wait=0, again=None)


def _lossy(attempts: _Attempts, lost: int, window: Time, wait: Time, acknowledged: Time) -> MissingMessages | str:
    asking, bursts = attempts.sent_in(attempts.trip) + attempts.trip // attempts.asks_every + 1, 0
    for _ in range(lost):
        bursts += lost + asking + lost * (lost + bursts)
        if bursts > MAX_BACKLOG:
            return f"with {lost} losses at a time, answers about them can multiply what is sent again"
    count = lost * (bursts + attempts.sent_in(acknowledged))
    again = Multiplied(SporadicEvents(window, lost * acknowledged + attempts.trip), count)
    return MissingMessages(wait=wait, again=again)


def _attempts(wire: Wire, messages: Sequence[Transmission], cycle: Cycle) -> _Attempts:
    """How the agent sends again what is missing.

    Raises
    ------
    UnknownError : some time of it has no bound.
    """
    solved = cycle.solved
    system = solved.context.system
    asking = [
        each
        for each in system.network.transmissions
        if (each.wire, each.direction, each.purpose) == (wire.name, Direction.TO_CONTROLLER, Purpose.HEARTBEAT)
    ]
    replies = [each for message in (*messages, *asking) if (each := answer_to(message, system)) is not None]
    arriving = _longest(received(each, solved) for each in (*messages, *asking))
    replying = _longest(sent(each, solved) for each in replies)
    again = _longest([agent_hop(each, solved)] for each in messages)
    written = cycle.processor.time(0, replying)
    if cycle.greatest_age is None or written is None:
        raise UnknownError("how long a message waits until it is read has no bound")
    assert wire.recovery is not None
    asks_every = wire.recovery.agent_asks_every
    handles = [_handle_of(each, cycle) for each in messages]
    events = [_sent_by_agent(*each, solved) for each in zip(handles, messages, strict=True)]
    regular = [
        max(each.period, handle.phase or 0) + each.jitter
        for handle, each in zip(handles, events, strict=True)
        if comes_regularly(handle, system)
    ]
    if regular and min(regular) < asks_every:
        solved.context.notes.assume(_ASSUMPTION)
    reading = arriving + cycle.greatest_age
    return _Attempts(
        messages=events,
        asks_every=asks_every,
        distance=min([*regular, asks_every]),
        trip=reading + written + again,
        reading=reading,
    )


def _handle_of(message: Transmission, cycle: Cycle) -> Handle:
    handles = (handle for each in cycle.solved.context.system.executors for handle in each.handles)
    taking = next((handle for handle in handles if handle.transmission == message.name), None)
    if taking is None:
        raise UnknownError(f"no executor takes {message.name!r}")
    return taking


def _sent_by_agent(handle: Handle, message: Transmission, solved: SolvedSystem) -> PeriodicEvents:
    """When the agent sends a message for the first time."""
    agent = agent_hop(message, solved)
    return arrivals(handle, {handle.name: None if agent.worst is None else agent.worst - agent.best})


def _longest(paths: Iterable[Iterable[Hop]]) -> Time:
    """The longest time of some sequences of hops."""
    longest = Time(0)
    for hops in map(list, paths):
        unknown = next((hop for hop in hops if hop.worst is None), None)
        if unknown is not None:
            raise UnknownError(unknown.reason)
        longest = max(longest, sum(hop.worst or 0 for hop in hops))
    return longest
