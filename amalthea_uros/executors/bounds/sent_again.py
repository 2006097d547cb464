"""How often messages are sent again on a wire that loses some, and how long that takes.

The agent says in each acknowledgement whether something is missing; then the client sends again all that is not acknowledged, at most H
messages (`src/c/core/session/session.c` of eProsima/Micro-XRCE-DDS-Client). docs/proofs/sent-again.md proves the bound: let T be the
longest time from a write of a reliable message or a heartbeat until its acknowledgement is read. Each loss is followed by at most

    a = H + 1 + heartbeats in T

acknowledgements that say that it is missing, and each of them by H messages. Of all losses before a window of length w, only those in
the last T count, and one more for all that are still missing then: at most H a (losses in w + T, and one more).

A publication reads all the time while it waits. If its timeout is longer than a round trip and the time b to acknowledge the
whole receive backlog, that is empty at some time before it ends, and everything that arrives after that is read b later, or after it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from amalthea_uros.executors.bounds.backlog import acknowledged
from amalthea_uros.executors.bounds.solved_system import SolvedSystem, ThreadProcessor
from amalthea_uros.executors.bounds.transmissions import agent_hop, received, sent, wire_hop
from amalthea_uros.executors.semantics.losses import answer_to, is_question, publications, reliable_messages, why_unbounded
from amalthea_uros.executors.semantics.readiness import reads_in_waits
from amalthea_uros.executors.semantics.suspension import NONE, Suspension, heartbeats
from amalthea_uros.perf.network import Direction, Losses, Purpose, Transmission, Wire
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.time_base import max_time
from amalthea_uros.timing.event_models.derived import Multiplied, aggregated
from amalthea_uros.timing.event_models.models import EventModel, SporadicEvents
from amalthea_uros.units import Time

#: After which the time to read everything is considered unbounded.
_STEPS = 1000
UNBOUNDED = "how often it is sent again, because messages are lost, has no bound"


def sent_again(
    solved: SolvedSystem, age: Time | None, processor: ThreadProcessor | None, distance: Time | None
) -> dict[str, EventModel | str]:
    """How often the controller sends messages again, all of them together, by the names of transmissions; or why that has no bound.

    Parameters
    ----------
    age : greatest age of an message of the receive backlog; None if it has no bound
    processor : as the thread sees it; None if it is not known
    distance : greatest distance of the beginnings of two publications that wait; None if it is not known
    """
    system = solved.context.system
    models: dict[str, EventModel | str] = {}
    for wire in system.network.wires:
        messages = reliable_messages(wire.name, Direction.TO_AGENT, system)
        if not wire.losses or not messages or why_unbounded(wire, system):
            continue
        again = _again(wire, age, processor, solved, distance)
        if again is not None and not losses_from_controller(wire):
            continue
        models |= dict.fromkeys((each.name for each in messages), UNBOUNDED if again is None else again)
    return models


def losses_from_controller(wire: Wire) -> list[Losses]:
    """The losses of a wire that messages of the controller are among."""
    return [each for each in wire.losses if Direction.TO_AGENT in each.directions]


def _again(
    wire: Wire, age: Time | None, processor: ThreadProcessor | None, solved: SolvedSystem, distance: Time | None
) -> EventModel | None:
    system, trip = solved.context.system, _longest_round_trip(wire, solved)
    asking = [each for each in heartbeats(system) if each.wire == wire.name]
    events = [solved.event_models.get(each.name) for each in asking]
    reading = None if age is None else reading_time(age, solved)
    if age is None or reading is None or processor is None or trip is None or None in events or wire.recovery is None:
        return None
    kept = min(wire.recovery.sent_parts or 0, most_kept(wire, reading, distance, processor, solved))
    # Others can keep the thread from reading.
    until_read, in_both = processor.time(0, trip + reading), processor.time(0, 2 * trip + reading)
    # Otherwise a publication could end before it has read what is missing.
    if until_read is None or in_both is None or _shortest_timeout(system) <= until_read:
        return None
    is_read_in_waits = any(map(reads_in_waits, system.executors))
    are_asked = any(is_question(each, system) for each in system.network.transmissions)
    longest = trip + age if is_read_in_waits or are_asked else in_both
    count = kept + 1 + sum(each.eta_plus(longest + 1) for each in events if each is not None)
    return aggregated(tuple(_bursts(wire, longest, count * kept)))


def most_kept(wire: Wire, reading: Time, distance: Time | None, processor: ThreadProcessor, solved: SolvedSystem) -> int:
    """The most messages that the client has to keep until they are acknowledged, the one that is published included.

    A publication whose time is long enough ends without an acknowledgement only if something is lost in it.

    Parameters
    ----------
    reading : longest time to read and answer the receive backlog
    distance : as in `sent_again`
    """
    limit, trip = (0 if wire.recovery is None else wire.recovery.sent_parts or 0), _longest_round_trip(wire, solved)
    until_read = None if trip is None else processor.time(0, trip + reading)
    if distance is None or until_read is None or _shortest_timeout(solved.context.system) <= 3 * until_read:
        return limit + 1
    lost = (sum(each.count * (1 + count * distance // each.window) for each in wire.losses) for count in range(1, limit + 1))
    return 1 + max((count for count, losses in enumerate(lost, 1) if count <= losses), default=0)


def is_refused(reading: Time, distance: Time | None, processor: ThreadProcessor, solved: SolvedSystem) -> bool:
    """Whether a publication can return at once, as the client keeps as many messages as it can; parameters as of `most_kept`."""
    return any(
        wire.recovery is None or most_kept(wire, reading, distance, processor, solved) > (wire.recovery.sent_parts or 0)
        for wire in solved.context.system.network.wires
        if wire.losses
    )


def _shortest_timeout(system: System) -> Time:
    """The shortest time for which a publication waits for its acknowledgement."""
    return min((each.timeout or 0 for each in publications(system) if each.waits and each.reliable), default=Time(0))


def _longest_round_trip(wire: Wire, solved: SolvedSystem) -> Time | None:
    """The longest time from the write of a reliable message or a heartbeat to its acknowledgement; None if it has no bound."""
    system = solved.context.system
    asking = (each for each in heartbeats(system) if each.wire == wire.name)
    trips = [_round_trip(each, solved) for each in (*reliable_messages(wire.name, Direction.TO_AGENT, system), *asking)]
    return None if None in trips else max(filter(None, trips), default=Time(0))


def _bursts(wire: Wire, longest: Time, count: int) -> Iterator[EventModel]:
    """So many messages for each loss, in the time after it, and for one more."""
    for each in losses_from_controller(wire):
        yield Multiplied(SporadicEvents(each.window, each.window + longest), each.count * count)


def _round_trip(message: Transmission, solved: SolvedSystem) -> Time | None:
    """From the write of what is acknowledged until the acknowledgement can be read; None if that has no bound."""
    reply = answer_to(message, solved.context.system)
    if reply is None:
        return None
    times = [each.worst for each in (*sent(message, solved), agent_hop(reply, solved), *received(reply, solved))]
    return None if None in times else sum(filter(None, times))


def repeated(direction: Direction, solved: SolvedSystem) -> Mapping[Transmission, EventModel]:
    """The messages in a direction that can be sent again, each with how often that is done of all of them together."""
    every = ((solved.context.system.transmissions[name], again) for name, again in solved.sent_again.items())
    return {each: again for each, again in every if (each.purpose, each.direction) == (Purpose.DATA, direction)}


def most_at_once(solved: SolvedSystem) -> int:
    """The most messages that the controller sends again for one acknowledgement."""
    wires = {each.wire for each in repeated(Direction.TO_AGENT, solved)}
    recoveries = (wire.recovery for wire in solved.context.system.network.wires if wire.name in wires)
    return max((each.sent_parts or 0 for each in recoveries if each is not None), default=0)


def reading_time(age: Time, solved: SolvedSystem) -> Time | None:
    """The longest time to read and acknowledge the whole receive backlog, without a pause; None if it has no bound.

    Parameters
    ----------
    age : greatest age of an message of the receive backlog
    """
    time: Time = 0
    for _ in range(_STEPS):
        again, replies = sent_again_in(age + time, solved), answers_in(age + time, solved)
        longer = None if again is None or replies is None else time_to_write(again + replies, solved)
        if longer is None or longer == time:
            return longer
        time = longer
    return None


def sent_again_in(time: Time | None, solved: SolvedSystem) -> int | None:
    """How many messages are sent again in a time, and heartbeats; None if that has no bound, 0 if none is lost."""
    again = next(iter(repeated(Direction.TO_AGENT, solved).values()), None)
    if again is None:
        return 0
    asking = [solved.event_models.get(each.name) for each in heartbeats(solved.context.system)]
    if time is None or None in asking:
        return None
    return again.eta_plus(time + 1) + sum(each.eta_plus(time + 1) for each in asking if each is not None)


def answers_in(time: Time | None, solved: SolvedSystem) -> int | None:
    """The most answers to what arrives in a time; None if that has no bound."""
    arriving = acknowledged(solved).values()
    if time is None or None in arriving:
        return None
    return sum(each.most(time) for each in arriving if each is not None)


def answers_besides(time: Time | None, solved: SolvedSystem) -> int | None:
    """The most answers of a wait to what arrives in a time, if messages are sent again to the controller; else it reads one message."""
    return answers_in(time, solved) if repeated(Direction.TO_CONTROLLER, solved) else 0


def time_to_write(count: int, solved: SolvedSystem) -> Time | None:
    """The longest time to write some messages of the controller, one after the other; None if it has no bound.

    Nobody else sends in this direction: the first one can wait for what was written before it, and each other one for that before it.
    """
    system = solved.context.system
    sent_by_client = [each for each in system.network.transmissions if each.direction is Direction.TO_AGENT]
    writes = [wire_hop(each, solved).worst for each in sent_by_client]
    if not count:
        return 0
    if not writes or None in writes:
        return None
    longest = max(filter(None, writes), default=Time(0))
    wires = {each.wire for each in sent_by_client}
    if any(len(wire.cores) < len(Direction) for wire in system.network.wires if wire.name in wires):
        return count * longest
    alone = (max_time(solved.context.demands[each.name].worst, solved.context.time_base(each.name)) for each in sent_by_client)
    return longest + count * max(alone, default=Time(0))


def writing_again(count: int | None, solved: SolvedSystem) -> Suspension:
    """How long a wait is extended by what it sends again."""
    if count == 0:
        return NONE
    most = None if count is None else time_to_write(count, solved)
    return Suspension(most=most, times=count or 1, why="it sends heartbeats and answers, and again what is not acknowledged")
