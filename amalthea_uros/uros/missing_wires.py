"""Topics between parts of a description whose messages reach a controller over a wire that is not described.

How often a message comes is stated at the callback that receives it, unless what sends it is described: then it follows from that and
from the time on the wire. Without a wire, the statement would have to be taken for true, whatever the sender does.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from amalthea_uros.perf.network import Direction, Purpose, plain_topic, request_topic, response_topic
from amalthea_uros.perf.system import System
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.chain_members import ChainElement, ChainMembers, Topics


def check_wires(members: ChainMembers, parts: Sequence[ChainMembers], system: System, problems: Notes) -> None:
    """Report callbacks to which something described sends messages, but not over a described wire.

    Parameters
    ----------
    members, parts : of the whole system, and of each of its controllers
    """
    software = system.software
    origins = {each.name: each.origin for each in (*software.tasks, *software.runnables)}
    handles = {handle.name for executor in system.executors for handle in executor.handles}
    for callback, topic in _without_wire(members.topics, system):
        element, senders = members.elements[callback], members.topics.senders.get(topic, ())
        own = next(part.elements for part in parts if callback in part.elements)
        is_of_host = any(topic in each.publishes for each in system.host.callbacks)
        if not is_of_host and callback not in handles and own.keys() >= {*senders} and _is_rarer(senders, own, element):
            continue
        text = f"{callback!r} receives {topic!r}, which is published here, too, but no wire is described on which it comes"
        advice = "Describe 'transport' and 'agent' of its middleware, or rename the topic if its messages come from elsewhere."
        problems.error("APP003", text, origins.get(element.runnable or element.process or ""), advice)


def _is_rarer(senders: Collection[str], own: Mapping[str, ChainElement], receiver: ChainElement) -> bool:
    """Whether the only sender sends no more often than is stated of a callback that is due in every n-th job of its executor."""
    least = [own[name].interval for name in senders]
    return len(least) == 1 and receiver.interval is not None and least[0] is not None and receiver.interval <= least[0]


def _without_wire(topics: Topics, system: System) -> Iterator[tuple[str, str]]:
    """Callbacks and topics."""
    carried = {
        (each.callback, plain_topic(each.topic))
        for each in system.network.transmissions
        if (each.direction, each.purpose) == (Direction.TO_CONTROLLER, Purpose.DATA)
    }
    sent = {*topics.senders, *(topic for callback in system.host.callbacks for topic in callback.publishes)}
    # What has a topic of its own for requests or responses is the name of a service, under which both are known, too.
    services = {name for name in sent if {request_topic(name), response_topic(name)} & topics.names}
    for topic in sorted((sent - services) & topics.receivers.keys()):
        yield from ((callback, topic) for callback in topics.receivers[topic] if (callback, topic) not in carried)
