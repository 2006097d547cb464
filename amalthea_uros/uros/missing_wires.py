"""Topics between parts of a description whose messages reach a controller over a wire that is not described.

How often a message comes is stated at the callback that receives it, unless what sends it is described: then it follows from that and
from the time on the wire. Without a wire, the statement would have to be taken for true, whatever the sender does.
"""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.perf.network import Direction, Purpose, plain_topic, request_topic, response_topic
from amalthea_uros.perf.system import System
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.chain_members import ChainMembers, Topics


def check_wires(members: ChainMembers, system: System, problems: Notes) -> None:
    """Report callbacks to which something described sends messages, but not over a described wire."""
    software = system.software
    origins = {each.name: each.origin for each in (*software.tasks, *software.runnables)}
    for callback, topic in _without_wire(members.topics, system):
        element = members.elements[callback]
        text = f"{callback!r} receives {topic!r}, which is published here, too, but no wire is described on which it comes"
        advice = "Describe 'transport' and 'agent' of its middleware, or rename the topic if its messages come from elsewhere."
        problems.error("APP003", text, origins.get(element.runnable or element.process or ""), advice)


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
