"""How long callbacks are held up by what they send.

A message is written to the transport before `rcl_publish` returns, which can take until its last byte is on the wire. After a reliable
one, the callback also waits until the acknowledgement has come or the timeout has passed (micro-ROS/rmw_microxrcedds
`rmw_microxrcedds_c/src/rmw_publish.c`): for the agent, which sends it after it has processed the message
(eProsima/Micro-XRCE-DDS-Agent `Processor.cpp`), and for the wire back. If one of these times is unknown, or the wire can lose frames,
it waits up to the timeout: a lost frame is sent again after a heartbeat, which incoming messages postpone
(eProsima/Micro-XRCE-DDS-Client `src/c/core/session/session.c`).

While it waits, it reads everything in the order of arrival (`uxr_run_session_until_confirm_delivery`, same file), answers each reliable
message and heartbeat, and writes heartbeats of its own. Let R be the round trip without this, and Q the greatest age of an unread
message (`analyze.executors.unread`). What it reads before the acknowledgement came at most Q before the message was written, and before
the end of the wait. So the wait is at most the least w with

    w = R + sum over the answers of write * eta(Q + w) + heartbeats * write

with one answer for each part of a message. The first heartbeat follows an interval after the message, if all was acknowledged before
it; the wait lies in one cycle L, so that w + L has room for (w + L) / interval of them.

It gives up when the timeout has passed, which begins when the message is written and is looked at between two readings. The last one
can write an answer, and heartbeats as long as the timeout lasts. If one of these writes has no bound, the publication has none.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from amalthea_uros.analyze.executors.cycle import Cycle, UnknownCycleError
from amalthea_uros.analyze.executors.unread import DUE, Arriving, answered, is_behind, publications
from amalthea_uros.analyze.solution import Solution
from amalthea_uros.analyze.ways.messages import agent_hop, received, sent, wire_hop
from amalthea_uros.analyze.ways.results import Hop
from amalthea_uros.perf.executors import Executor, Publication
from amalthea_uros.perf.network import Span, Transmission
from amalthea_uros.timing.executors.answers import answers, heartbeats
from amalthea_uros.units import Time

#: After which times are considered unbounded.
_STEPS = 1000
_ROUNDS = 100


@dataclass(frozen=True, slots=True, kw_only=True)
class _Session:
    """What a publication can meet.

    Attributes
    ----------
    unread : the greatest age of an unread message; None if it has no bound
    cycle : the longest cycle; None if it has no bound
    is_behind : whether something sent earlier can still have no acknowledgement
    """

    unread: Time | None = 0
    cycle: Time | None = 0
    is_behind: bool = False


def sending_times(solution: Solution) -> Mapping[str, Span]:
    """How long a thread is held up by each message that it sends, by the names of transmissions.

    Besides the messages of callbacks, these are the acknowledgements and heartbeats that it sends.
    """
    system = solution.context.system
    arrivals = answered(solution)
    sessions = {each.name: _Session() for each in system.executors}
    for _ in range(_ROUNDS):
        sending = _times(sessions, arrivals, solution)
        found = {each.name: _session(each, sending, solution) for each in system.executors}
        if found == sessions or not any(each.waits for each in publications(system)):
            return sending
        sessions = found
    unknown = _Session(unread=None, cycle=None, is_behind=True)
    return _times(dict.fromkeys(sessions, unknown), arrivals, solution)


def _times(sessions: Mapping[str, _Session], arrivals: Mapping[str, Arriving | None], solution: Solution) -> Mapping[str, Span]:
    system = solution.context.system
    own = (*answers(system), *heartbeats(system))
    return {each.name: _until_written(each, solution) for each in own} | {
        publication.transmission: _until_acknowledged(publication, sessions[executor.name], arrivals, solution)
        if publication.waits
        else _until_written(system.transmissions.get(publication.transmission), solution)
        for executor in system.executors
        for handle in executor.handles
        for publication in handle.publications
        if publication.transmission is not None
    }


def _session(executor: Executor, sending: Mapping[str, Span], solution: Solution) -> _Session:
    """What the publications of an executor can meet, if they take such times."""
    behind = is_behind(sending, solution)
    try:
        cycle = Cycle.of(executor, solution, sending)
    except UnknownCycleError:
        return _Session(unread=None, cycle=None, is_behind=behind)
    return _Session(unread=cycle.unread, cycle=cycle.longest, is_behind=behind)


def _until_written(message: Transmission | None, solution: Solution) -> Span:
    """A driver can return at once, or when the message is on the wire."""
    return Span(most=None) if message is None else Span(most=wire_hop(message, solution).worst)


def _until_acknowledged(
    publication: Publication, session: _Session, arrivals: Mapping[str, Arriving | None], solution: Solution
) -> Span:
    hops = list(_round_trip(publication, solution))
    least = sum(hop.best for hop in hops)
    times = [hop.worst for hop in hops]
    known = None if not hops or None in times or _can_lose(publication, solution) else sum(filter(None, times))
    most = _least(None if known is None else _with_writes(known, session, arrivals, solution), _gives_up(publication, solution))
    return Span(least=least if most is None else min(least, most), most=most)


def _with_writes(time: Time, session: _Session, arrivals: Mapping[str, Arriving | None], solution: Solution) -> Time | None:
    """The time of a round trip with what is written meanwhile; None if it has no bound."""
    whole = time
    for _ in range(_STEPS):
        answering = _answering(whole, session, arrivals, solution)
        beating = _beating(whole, session, solution)
        if answering is None or beating is None:
            return None
        if time + answering + beating == whole:
            return whole
        whole = time + answering + beating
    return None


def _answering(wait: Time, session: _Session, arrivals: Mapping[str, Arriving | None], solution: Solution) -> Time | None:
    """The time to answer all that is read in a wait; None if it has no bound."""
    total: Time = 0
    for name, arriving in arrivals.items():
        write = _until_written(solution.context.system.transmissions[name], solution).most
        if write is None or arriving is None or session.unread is None:
            return None
        total += write * arriving.most(session.unread + wait)
    return total


def _beating(wait: Time, session: _Session, solution: Solution) -> Time | None:
    """The time to write the heartbeats of a wait; None if it has no bound."""
    if not heartbeats(solution.context.system):
        return 0
    return None if session.cycle is None else _heartbeats(session.cycle + wait, int(session.is_behind), solution)


def _heartbeats(time: Time, first: int, solution: Solution) -> Time | None:
    """The time to write some heartbeats and those that follow in some time; None if it has no bound."""
    total: Time = 0
    for each in heartbeats(solution.context.system):
        events, write = solution.event_models.get(each.name), _until_written(each, solution).most
        if events is None or not (interval := events.delta_min(2)):
            return None
        count = first + time // interval
        if count and write is None:
            return None
        total += count * (write or 0)
    return total


def _gives_up(publication: Publication, solution: Solution) -> Time | None:
    """When a publication gives up; None if it does not, or what it writes has no bound."""
    transmissions = solution.context.system.transmissions
    written = _until_written(transmissions.get(publication.transmission or ""), solution).most
    answering = [_until_written(each, solution).most for each in answers(solution.context.system)]
    if publication.timeout is None or written is None or None in answering:
        return None
    beating = _heartbeats(publication.timeout, DUE, solution)
    return None if beating is None else written + publication.timeout + max(filter(None, answering), default=0) + beating


def _round_trip(publication: Publication, solution: Solution) -> Iterator[Hop]:
    """The hops of a message and of its acknowledgement; none if a wire is not described."""
    transmissions = solution.context.system.transmissions
    message, answer = (transmissions.get(name or "") for name in (publication.transmission, publication.acknowledgement))
    if message is not None and answer is not None:
        yield from sent(message, solution)
        yield agent_hop(answer, solution)
        yield from received(answer, solution)


def _can_lose(publication: Publication, solution: Solution) -> bool:
    """Whether frames can be lost on the wire of a message."""
    network = solution.context.system.network
    message = solution.context.system.transmissions.get(publication.transmission or "")
    return any(wire.loses_messages for wire in network.wires if message is not None and wire.name == message.wire)


def _least(one: Time | None, other: Time | None) -> Time | None:
    known = [time for time in (one, other) if time is not None]
    return min(known) if known else None
