"""How long callbacks are held up by what they send.

A message is written to the transport before `rcl_publish` returns, which can take until its last byte is on the wire. After a reliable
one, the callback also waits until the acknowledgement has come or the timeout has passed (micro-ROS/rmw_microxrcedds
`rmw_microxrcedds_c/src/rmw_publish.c`): for the agent, which sends it after it has processed the message
(eProsima/Micro-XRCE-DDS-Agent `Processor.cpp`), and for the wire back. If one of these times is unknown, or the wire can lose frames,
it waits up to the timeout: a lost frame is sent again after a heartbeat, which incoming messages postpone
(eProsima/Micro-XRCE-DDS-Client `session.c`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from amalthea_uros.analyze.solution import Solution
from amalthea_uros.analyze.ways.messages import agent_hop, received, sent, wire_hop
from amalthea_uros.analyze.ways.results import Hop
from amalthea_uros.perf.executors import Publication
from amalthea_uros.perf.network import Span, Transmission
from amalthea_uros.timing.event_models import EventModel
from amalthea_uros.timing.executors.answers import answers
from amalthea_uros.units import Time

#: Messages of each kind that can wait unread when a publication begins.
WAITING = 1
#: After which a round trip is considered unbounded.
_STEPS = 1000


def sending_times(solution: Solution) -> Mapping[str, Span]:
    """How long a thread is held up by each message that it sends, by the names of transmissions.

    Besides the messages of callbacks, these are the acknowledgements that it sends.
    """
    system = solution.context.system
    handles = (handle for executor in system.executors for handle in executor.handles)
    return {each.name: _until_written(each, solution) for each in answers(system)} | {
        publication.transmission: _until_acknowledged(publication, solution)
        if publication.waits
        else _until_written(system.transmissions.get(publication.transmission), solution)
        for handle in handles
        for publication in handle.publications
        if publication.transmission is not None
    }


def _until_written(message: Transmission | None, solution: Solution) -> Span:
    """A driver can return at once, or when the message is on the wire."""
    return Span(most=None) if message is None else Span(most=wire_hop(message, solution).worst)


def _until_acknowledged(publication: Publication, solution: Solution) -> Span:
    hops = list(_round_trip(publication, solution))
    least = sum(hop.best for hop in hops)
    times = [hop.worst for hop in hops]
    known = None if not hops or None in times or _can_lose(publication, solution) else sum(filter(None, times))
    most = _least(None if known is None else _with_answers(known, solution), _gives_up(publication, solution))
    return Span(least=least if most is None else min(least, most), most=most)


def _with_answers(time: Time, solution: Solution) -> Time | None:
    """The time of a round trip with the acknowledgements of what is read meanwhile, or was waiting; None if it has no bound."""
    found = [(_until_written(each, solution).most, _counted_by(each, solution)) for each in answers(solution.context.system)]
    whole, before = time, -1
    for _ in range(_STEPS):
        if whole == before:
            return whole
        total = time
        for write, events in found:
            if write is None or events is None:
                return None
            total += write * (events.eta_plus(whole) + WAITING)
        whole, before = total, whole
    return None


def _counted_by(answer: Transmission, solution: Solution) -> EventModel | None:
    """The event model of the messages that an acknowledgement answers."""
    return solution.event_models.get(answer.name.removesuffix("_acknowledgement"))


def _gives_up(publication: Publication, solution: Solution) -> Time | None:
    """When a publication gives up: the timeout begins when the message is written, and is looked at between two readings."""
    written = _until_written(solution.context.system.transmissions.get(publication.transmission or ""), solution).most
    answered = [_until_written(each, solution).most for each in answers(solution.context.system)]
    if publication.timeout is None or written is None or None in answered:
        return None
    return written + publication.timeout + max(filter(None, answered), default=0)


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
