"""The wire of a description, and whether it is a part of the system."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from amalthea_uros.perf.network import plain_topic
from amalthea_uros.spec.application import NodeSection
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.transports import Can, CanFd
from amalthea_uros.uros.transports.can import CanFdLine, CanLine
from amalthea_uros.uros.transports.driven import CustomLine, DrivenLine, SerialLine, TcpLine, UdpLine, UsbCdcLine
from amalthea_uros.uros.transports.line import Line, describes_wire, wire_sections

_DRIVEN: Mapping[str, type[DrivenLine]] = {kind.key: kind for kind in (SerialLine, UdpLine, TcpLine, UsbCdcLine, CustomLine)}


def line_of(description: Description) -> Line | None:
    """The wire of a description; None if it has none. Of several ones, which is an error, the first."""
    match next(wire_sections(description.middleware.transport), None):
        case None:
            return None
        case _, Can() as section:
            return CanLine(section=section)
        case _, CanFd() as section:
            return CanFdLine(section=section)
        case key, section:
            return _DRIVEN[key](section=section, tick=description.os.tick)


def is_in_system(description: Description) -> bool:
    """Whether the wire is a part of the system.

    A classic CAN bus is one only where something asks for it: an executor that loops, a latency of the agent, foreign frames, a
    host, a chain with a topic, or a topic that the controller both publishes and receives.
    """
    middleware = description.middleware
    can = middleware.transport.can
    if can is None:
        return describes_wire(middleware.transport)
    agent = middleware.agent
    return (
        any(executor.loop is not None for executor in (middleware.executor, *middleware.executors))
        or any(latency is not None for latency in (agent.to_controller, agent.to_host, agent.acknowledgement))
        or bool(can.foreign or can.dbc)
        or description.host is not None
        or _has_chain_with_topic(description)
        or _receives_own(description)
    )


def _receives_own(description: Description) -> bool:
    """Whether a controller receives topics that it publishes, or calls its own services."""
    nodes = description.application.nodes
    received = {subscription.topic for node in nodes for subscription in node.subscriptions}
    received |= {service.name for node in nodes for service in (*node.services, *node.action_servers)}
    sent = {publisher.topic for node in nodes for publisher in node.publishers}
    sent |= {client.service for node in nodes for client in node.clients}
    sent |= {client.action for node in nodes for client in node.action_clients}
    return not {*map(plain_topic, received)}.isdisjoint(map(plain_topic, sent))


def _has_chain_with_topic(description: Description) -> bool:
    topics = {topic.lstrip("/") for topic in _topics(description)}
    others = {name for node in description.application.nodes for name in _named(node)} | {*description.labels}
    others |= {process.name for process in (*description.tasks, *description.isrs)}
    paths = (path for chain in description.chains for path in (chain.path or (), *(chain.parallel or ())))
    return any(name.startswith("/") or name in topics - others for path in paths for name in path)


def _topics(description: Description) -> Iterator[str]:
    for node in description.application.nodes:
        yield from (subscription.topic for subscription in node.subscriptions)
        yield from (publisher.topic for publisher in node.publishers)


def _named(node: NodeSection) -> Iterator[str]:
    """The callbacks of a node, and the labels that they read and write."""
    for callback in (*node.subscriptions, *node.timers, *node.services, *node.clients):
        yield from (callback.name, *callback.reads, *callback.writes)
