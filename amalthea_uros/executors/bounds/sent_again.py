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

from collections.abc import Iterable, Iterator

from amalthea_uros.executors.bounds.solved_system import SolvedSystem, ThreadProcessor
from amalthea_uros.executors.bounds.transmissions import agent_hop, received, sent, wire_hop
from amalthea_uros.executors.semantics.losses import acknowledged_from_controller, publications, why_unbounded
from amalthea_uros.executors.semantics.suspension import NONE, Suspension, heartbeats
from amalthea_uros.perf.network import Direction, Losses, Transmission, Wire
from amalthea_uros.timing.basics.time_base import max_time
from amalthea_uros.timing.event_models.models import EventModel, Multiplied, SporadicEvents, aggregated
from amalthea_uros.units import Time

#: After which the time to read everything is considered unbounded.
_STEPS = 1000


def sent_again(
    solved: SolvedSystem, age: Time | None, processor: ThreadProcessor | None, *, reads_in_waits: bool
) -> dict[str, EventModel | None]:
    """How often messages are sent again, by the names of transmissions: all of the controller together; None if that is not known.

    Parameters
    ----------
    age : greatest age of an message of the receive backlog; None if it has no bound
    processor : as the thread sees it; None if it is not known
    reads_in_waits : whether the waits of iterations read; else only publications do, and only they send heartbeats
    """
    system = solved.context.system
    models: dict[str, EventModel | None] = {}
    for wire in system.network.wires:
        messages = acknowledged_from_controller(wire.name, system)
        if not wire.losses or not messages or why_unbounded(wire, system):
            continue
        again = _again(wire, messages, age, processor, solved, reads_in_waits)
        if again is not None and not losses_from_controller(wire):
            continue
        names = {each.name for each in messages}
        acknowledging = (each.name for each in system.network.transmissions if each.acknowledges in names)
        models |= dict.fromkeys((*names, *acknowledging), again)
    return models


def losses_from_controller(wire: Wire) -> list[Losses]:
    """The losses of a wire that messages of the controller are among."""
    return [each for each in wire.losses if Direction.TO_AGENT in each.directions]


def _again(
    wire: Wire,
    messages: Iterable[Transmission],
    age: Time | None,
    processor: ThreadProcessor | None,
    solved: SolvedSystem,
    reads_in_waits: bool,
) -> EventModel | None:
    system = solved.context.system
    asking = [each for each in heartbeats(system) if each.wire == wire.name]
    trips = [_round_trip(each, solved) for each in (*messages, *asking)]
    events = [solved.event_models.get(each.name) for each in asking]
    reading = None if age is None else reading_time(age, solved)
    if age is None or reading is None or processor is None or None in trips or None in events or wire.recovery is None:
        return None
    trip, kept = max(filter(None, trips), default=Time(0)), wire.recovery.sent_parts or 0
    # Others can keep the thread from reading.
    until_read, in_both = processor.time(0, trip + reading), processor.time(0, 2 * trip + reading)
    timeouts = [each.timeout or 0 for each in publications(system) if each.waits]
    # Otherwise a publication could end before it has read what is missing.
    if until_read is None or in_both is None or min(timeouts, default=0) <= until_read:
        return None
    longest = trip + age if reads_in_waits else in_both
    count = kept + 1 + sum(each.eta_plus(longest + 1) for each in events if each is not None)
    return aggregated(tuple(_bursts(wire, longest, count * kept)))


def _bursts(wire: Wire, longest: Time, count: int) -> Iterator[EventModel]:
    """So many messages for each loss, in the time after it, and for one more."""
    for each in losses_from_controller(wire):
        yield Multiplied(SporadicEvents(each.window, each.window + longest), each.count * count)


def _round_trip(message: Transmission, solved: SolvedSystem) -> Time | None:
    """From the write of what is acknowledged until the acknowledgement can be read; None if that has no bound."""
    reply = next((each for each in solved.context.system.network.transmissions if each.acknowledges == message.name), None)
    if reply is None:
        return None
    times = [each.worst for each in (*sent(message, solved), agent_hop(reply, solved), *received(reply, solved))]
    return None if None in times else sum(filter(None, times))


def total(solved: SolvedSystem) -> EventModel | None:
    """How often the controller sends messages again; None if it does not."""
    return next(iter(solved.sent_again.values()), None)


def most_at_once(solved: SolvedSystem) -> int:
    """The most messages that the controller sends again for one acknowledgement."""
    wires = {solved.context.system.transmissions[name].wire for name in solved.sent_again}
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
        count = sent_again_in(age + time, solved)
        longer = None if count is None else time_to_write_again(count, solved)
        if longer is None or longer == time:
            return longer
        time = longer
    return None


def sent_again_in(time: Time | None, solved: SolvedSystem) -> int | None:
    """How many messages are sent again in a time, and heartbeats; None if that has no bound, 0 if none is lost."""
    again = total(solved)
    if again is None:
        return 0
    asking = [solved.event_models.get(each.name) for each in heartbeats(solved.context.system)]
    if time is None or None in asking:
        return None
    return again.eta_plus(time + 1) + sum(each.eta_plus(time + 1) for each in asking if each is not None)


def time_to_write_again(count: int, solved: SolvedSystem) -> Time | None:
    """The longest time to write some messages again, and heartbeats, one after the other; None if it has no bound.

    Nobody else sends in this direction: the first one can wait for what was written before it, and each other one for that before it.
    """
    system = solved.context.system
    messages = [system.transmissions[name] for name in solved.sent_again]
    sent_by_client = [each for each in (*messages, *heartbeats(system)) if each.direction is Direction.TO_AGENT]
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
    most = None if count is None else time_to_write_again(count, solved)
    return Suspension(most=most, times=count or 1, why="it sends heartbeats, and again what is not acknowledged")
