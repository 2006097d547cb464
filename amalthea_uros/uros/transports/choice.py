"""The wire of a description."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.perf.network import WireKind
from amalthea_uros.spec.application import NodeSection
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.transports import Can, CanFd, CustomTransport, Driver, Serial, UsbCdc
from amalthea_uros.units import Time
from amalthea_uros.uros.transports.can_fd import CanFdLine
from amalthea_uros.uros.transports.classic_can import CanLine
from amalthea_uros.uros.transports.custom import CustomLine
from amalthea_uros.uros.transports.line import Line, describes_wire, wire_sections
from amalthea_uros.uros.transports.serial import SerialLine
from amalthea_uros.uros.transports.tcp import TcpLine
from amalthea_uros.uros.transports.udp import UdpLine
from amalthea_uros.uros.transports.usb_cdc import UsbCdcLine


def line_of(description: Description, tick: Time | None) -> Line | None:
    """The wire of a description; None if it has none. Of several ones, which is an error, the first.

    Parameters
    ----------
    tick : of the operating system, for drivers that state no other one
    """
    stated = next(wire_sections(description.middleware.transport), None)
    if stated is None:
        return None
    key, section = stated
    match section:
        case Can():
            return CanLine(section=section)
        case CanFd():
            return CanFdLine(section=section)
    tick = section.driver.tick or tick
    match section:
        case Serial():
            return SerialLine(section=section, tick=tick)
        case UsbCdc():
            return UsbCdcLine(section=section, tick=tick)
        case CustomTransport():
            return CustomLine(section=section, tick=tick)
    return UdpLine(section=section, tick=tick) if key == "udp" else TcpLine(section=section, tick=tick)


def driver_of(line: Line) -> Driver | None:
    """The driver of a wire; a CAN controller has none to describe."""
    return None if isinstance(line.section, Can | CanFd) else line.section.driver


def is_bus(line: Line) -> bool:
    """Whether identifiers decide who sends."""
    return line.kind in (WireKind.CAN, WireKind.CAN_FD)


def keeps_sender(line: Line) -> bool:
    """Whether a thread that sends waits until its message is on the wire.

    Drivers of streams of bytes do; network stacks and CAN controllers have buffers.
    """
    return line.kind in (WireKind.SERIAL, WireKind.USB_CDC, WireKind.CUSTOM)


def is_in_system(description: Description) -> bool:
    """Whether the wire is a part of the system.

    A classic CAN bus is one only where something asks for it: an executor that loops, a latency of the agent, frames of others, or a
    chain with a topic.
    """
    middleware = description.middleware
    can = middleware.transport.can
    if can is None:
        return describes_wire(middleware.transport)
    executors = (middleware.executor, *middleware.executors)
    agent = middleware.agent
    return (
        any(executor.loop is not None for executor in executors)
        or any(latency is not None for latency in (agent.to_controller, agent.to_host, agent.acknowledgement))
        or bool(can.foreign or can.dbc)
        or _has_chain_with_topic(description)
    )


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
