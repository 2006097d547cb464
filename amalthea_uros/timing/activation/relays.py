"""Messages of controllers that come to a controller again: their times are those of the publications.

An agent sends a message back itself. Between the agents of two controllers, the message takes the latency of its topic.
"""

from __future__ import annotations

from amalthea_uros.perf.executors import Handle
from amalthea_uros.perf.network import Direction, Purpose, Span, Transmission, plain_topic
from amalthea_uros.perf.system import System


def relayed(transmission: Transmission, system: System) -> list[Transmission]:
    """The messages from any controller that agents send here as another one."""
    if transmission.direction is not Direction.TO_CONTROLLER or transmission.purpose is not Purpose.DATA:
        return []
    others = system.transmissions.values()
    return [
        each
        for each in others
        if (each.direction, each.purpose) == (Direction.TO_AGENT, Purpose.DATA)
        and plain_topic(each.topic) == plain_topic(transmission.topic)
    ]


def sends_to_controllers(system: System) -> bool:
    """Whether agents send to a controller what the same or another one publishes."""
    return any(relayed(each, system) for each in system.network.transmissions)


def latency_between(sent: Transmission, received: Transmission, system: System) -> Span:
    """The time of a message from the agent of its sender to that of its receiver; unknown if it is not stated."""
    if sent.wire == received.wire:
        return Span(most=0)
    topic = plain_topic(received.topic)
    return next((each.latency for each in system.host.topics if each.name == topic), Span())


def comes_regularly(handle: Handle, system: System) -> bool:
    """Whether messages of a handle come for certain, one in each interval: nothing described publishes them."""
    transmission = system.transmissions.get(handle.transmission or "")
    if transmission is None:
        return handle.is_periodic
    # Callbacks of the host can skip periods and lose messages.
    is_of_host = any(plain_topic(transmission.topic) in callback.publishes for callback in system.host.callbacks)
    return handle.is_periodic and not is_of_host and not relayed(transmission, system)


def arrives_regularly(handle: Handle, system: System) -> bool:
    """Whether a message of a handle arrives for certain in each interval: it comes regularly, and is not gone if it is lost."""
    transmission = system.transmissions.get(handle.transmission or "")
    lossy = {wire.name for wire in system.network.wires if wire.loses_messages}
    can_be_lost = transmission is not None and transmission.wire in lossy and not handle.reliable
    return comes_regularly(handle, system) and not can_be_lost
