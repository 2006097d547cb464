"""How long callbacks are held up by what they send.

A message is written to the transport before `rcl_publish` returns, which can take until its last byte is on the wire. After a reliable
one, the callback also waits until the acknowledgement has come or the timeout has passed (micro-ROS/rmw_microxrcedds
`rmw_microxrcedds_c/src/rmw_publish.c`): for the agent, which sends it after it has processed the message
(eProsima/Micro-XRCE-DDS-Agent `Processor.cpp`), and for the wire back. If one of these times is unknown, or the wire can lose frames,
it waits up to the timeout: a lost frame is sent again after a heartbeat, which incoming messages postpone
(eProsima/Micro-XRCE-DDS-Client `src/c/core/session/session.c`).

While it waits, it reads everything in the order of arrival (`uxr_run_session_until_confirm_delivery`, same file), answers each reliable
message and heartbeat, and writes heartbeats of its own. Let R be the round trip without this, and Q the greatest age of an unread
message (`executors.bounds.backlog`). What it reads before the acknowledgement came at most Q before the message was written, and before
the end of the wait. So the wait is at most the least w with

    w = R + sum over the answers of write * eta(Q + w) + heartbeats * write

with one answer for each part of a message. The first heartbeat follows an interval after the message, if all was acknowledged before
it; the wait lies in one cycle L, so that w + L has room for (w + L) / interval of them.

It times out when the timeout has passed, which begins when the message is written and is looked at between two readings. The last one
can write an answer, or send again what is not acknowledged (`sent_again`), and heartbeats as long as the timeout lasts. If one of these
writes has no bound, the publication has none.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.bounds.backlog import DUE, Arriving, acknowledged, has_unacknowledged, max_heartbeats
from amalthea_uros.executors.bounds.cycle import Cycle
from amalthea_uros.executors.bounds.sent_again import most_at_once, time_to_write
from amalthea_uros.executors.bounds.solved_system import SolvedSystem
from amalthea_uros.executors.bounds.transmissions import agent_hop, received, sent, wire_hop
from amalthea_uros.executors.results import Hop
from amalthea_uros.executors.semantics.losses import publications, recovers
from amalthea_uros.executors.semantics.suspension import acknowledgements, heartbeats
from amalthea_uros.perf.executors import Executor, Publication
from amalthea_uros.perf.network import Span, Transmission
from amalthea_uros.units import Time

#: After which times are considered unbounded.
_STEPS = 1000
_ITERATIONS = 100


@dataclass(frozen=True, slots=True, kw_only=True)
class _Session:
    """What a publication can meet.

    Attributes
    ----------
    backlog_age : the greatest age of an unread message; None if it has no bound
    cycle : the longest cycle; None if it has no bound
    has_unacknowledged : whether something sent earlier can still have no acknowledgement
    """

    backlog_age: Time | None = 0
    cycle: Time | None = 0
    has_unacknowledged: bool = False


def sending_times(solved: SolvedSystem) -> Mapping[str, Span]:
    """How long a thread is held up by each message that it sends, by the names of transmissions.

    Besides the messages of callbacks, these are the acknowledgements and heartbeats that it sends.
    """
    system = solved.context.system
    arrivals = acknowledged(solved)
    sessions = {each.name: _Session() for each in system.executors}
    cycles = {each.name: _cycle(each, solved) for each in system.executors}
    for _ in range(_ITERATIONS):
        sending = _times(sessions, arrivals, solved)
        found = {name: _session(cycle, sending, solved) for name, cycle in cycles.items()}
        if found == sessions or not any(each.waits for each in publications(system)):
            return sending
        sessions = found
    unknown = _Session(backlog_age=None, cycle=None, has_unacknowledged=True)
    return _times(dict.fromkeys(sessions, unknown), arrivals, solved)


def _times(
    sessions: Mapping[str, _Session], arrivals: Mapping[str, Arriving | None], solved: SolvedSystem
) -> Mapping[str, Span]:
    system = solved.context.system
    own = (*acknowledgements(system), *heartbeats(system))
    return {each.name: _until_written(each, solved) for each in own} | {
        publication.transmission: _until_acknowledged(publication, sessions[executor.name], arrivals, solved)
        if publication.waits
        else _until_written(system.transmissions.get(publication.transmission), solved)
        for executor in system.executors
        for handle in executor.handles
        for publication in handle.publications
        if publication.transmission is not None
    }


def _cycle(executor: Executor, solved: SolvedSystem) -> Cycle | None:
    """The cycle of an executor before it is known how long publications take; None if it has no bound whatever they do."""
    try:
        return Cycle.without_sending(executor, solved)
    except UnknownError:
        return None


def _session(cycle: Cycle | None, sending: Mapping[str, Span], solved: SolvedSystem) -> _Session:
    """What the publications of an executor can meet, if they take such times."""
    unacknowledged = has_unacknowledged(sending, solved)
    if cycle is None:
        return _Session(backlog_age=None, cycle=None, has_unacknowledged=unacknowledged)
    cycle = cycle.with_sending(sending)
    return _Session(backlog_age=cycle.backlog_age, cycle=cycle.longest, has_unacknowledged=unacknowledged)


def _until_written(message: Transmission | None, solved: SolvedSystem) -> Span:
    """A driver can return at once, or when the message is on the wire."""
    return Span(most=None) if message is None else Span(most=wire_hop(message, solved).worst)


def _until_acknowledged(
    publication: Publication, session: _Session, arrivals: Mapping[str, Arriving | None], solved: SolvedSystem
) -> Span:
    hops = list(_round_trip(publication, solved))
    least = sum(hop.best for hop in hops)
    times = [hop.worst for hop in hops]
    known = None if not hops or None in times or _can_lose(publication, solved) else sum(filter(None, times))
    whole = None if known is None else _with_writes(known, session, arrivals, solved)
    if whole is not None and publication.attempts > 1 and whole > (publication.timeout or 0) // publication.attempts:
        # Further attempts are written before the answer to the first one comes.
        whole = None
    most = _lesser(whole, _until_timeout(publication, solved))
    if publication.timeout is not None:
        # Its timeout can pass while the driver still has the message.
        least = min(least, publication.timeout)
    if recovers(publication, solved.context.system):
        # It returns at once if the client still keeps as many messages as it can.
        least = Time(0)
    return Span(least=least if most is None else min(least, most), most=most)


def _with_writes(time: Time, session: _Session, arrivals: Mapping[str, Arriving | None], solved: SolvedSystem) -> Time | None:
    """The time of a round trip with what is written meanwhile; None if it has no bound."""
    whole = time
    for _ in range(_STEPS):
        acknowledging = _time_to_acknowledge(whole, session, arrivals, solved)
        heartbeat_time = _time_for_heartbeats(whole, session, solved)
        if acknowledging is None or heartbeat_time is None:
            return None
        if time + acknowledging + heartbeat_time == whole:
            return whole
        whole = time + acknowledging + heartbeat_time
    return None


def _time_to_acknowledge(
    wait: Time, session: _Session, arrivals: Mapping[str, Arriving | None], solved: SolvedSystem
) -> Time | None:
    """The time to answer all that is read in a wait; None if it has no bound."""
    total: Time = 0
    for name, arriving in arrivals.items():
        write = _until_written(solved.context.system.transmissions[name], solved).most
        if write is None or arriving is None or session.backlog_age is None:
            return None
        total += write * arriving.most(session.backlog_age + wait)
    return total


def _time_for_heartbeats(wait: Time, session: _Session, solved: SolvedSystem) -> Time | None:
    """The time to write the heartbeats of a wait; None if it has no bound."""
    if not heartbeats(solved.context.system):
        return 0
    return None if session.cycle is None else _heartbeat_time(session.cycle + wait, int(session.has_unacknowledged), solved)


def _heartbeat_time(time: Time, first: int, solved: SolvedSystem) -> Time | None:
    """The time to write some heartbeats and those that follow in some time; None if it has no bound."""
    total: Time = 0
    for each in heartbeats(solved.context.system):
        events, write = solved.event_models.get(each.name), _until_written(each, solved).most
        if events is None or not (interval := events.delta_min(2)):
            return None
        count = first + time // interval
        if count and write is None:
            return None
        total += count * (write or 0)
    return total


def _until_timeout(publication: Publication, solved: SolvedSystem) -> Time | None:
    """When a publication times out; None if it does not, or what it writes has no bound."""
    transmissions = solved.context.system.transmissions
    if publication.timeout is not None and (kept := most_at_once(solved)):
        # It writes its message, heartbeats, and at last an answer, or again what is missing, one after the other.
        beats = max_heartbeats(publication.timeout, solved)
        writing = None if beats is None else time_to_write(publication.attempts + beats + kept, solved)
        return None if writing is None else publication.timeout + writing
    written = _until_written(transmissions.get(publication.transmission or ""), solved).most
    writes = [_until_written(each, solved).most for each in acknowledgements(solved.context.system)]
    if publication.timeout is None or written is None or None in writes:
        return None
    beats_time = _heartbeat_time(publication.timeout, DUE, solved)
    if beats_time is None:
        return None
    return publication.attempts * written + publication.timeout + max(filter(None, writes), default=0) + beats_time


def _round_trip(publication: Publication, solved: SolvedSystem) -> Iterator[Hop]:
    """The hops of a message and of its acknowledgement; none if a wire is not described."""
    transmissions = solved.context.system.transmissions
    message, answer = (transmissions.get(name or "") for name in (publication.transmission, publication.acknowledgement))
    if message is not None and answer is not None:
        yield from sent(message, solved)
        yield agent_hop(answer, solved)
        yield from received(answer, solved)


def _can_lose(publication: Publication, solved: SolvedSystem) -> bool:
    """Whether frames can be lost on the wire of a message."""
    network = solved.context.system.network
    message = solved.context.system.transmissions.get(publication.transmission or "")
    return any(wire.loses_messages for wire in network.wires if message is not None and wire.name == message.wire)


def _lesser(one: Time | None, other: Time | None) -> Time | None:
    known = [time for time in (one, other) if time is not None]
    return min(known) if known else None
