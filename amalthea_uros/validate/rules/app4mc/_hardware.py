"""Ports and connections of hardware."""

from __future__ import annotations

from collections import Counter

from amalthea_uros.metamodel.classes import ConnectionHandler, HwConnection, HwModule, HwPort
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context


def is_internal(connection: HwConnection) -> bool:
    """Whether a connection belongs to a connection handler."""
    return isinstance(connection.container, ConnectionHandler)


def connections_outside(context: Context) -> Counter[HwPort]:
    """The number of connections at each port, not counting those inside connection handlers."""
    return Counter(
        port for connection in context.all(HwConnection) if not is_internal(connection) for port in set(_ports(connection))
    )


def share_no_port(first: Element, second: Element) -> bool:
    """Whether two connections or modules certainly have no port in common; False if one of them is unresolved."""
    if first.unresolved is not None or second.unresolved is not None:
        return False
    if isinstance(second, HwConnection):  # it has two ports, a module may have many
        first, second = second, first
    return not any(_has(second, port) for port in _ports(first))


def _ports(element: Element) -> list[HwPort]:
    if isinstance(element, HwConnection):
        return [port for port in (element.port1, element.port2) if port is not None]
    return element.ports if isinstance(element, HwModule) else []


def _has(element: Element, port: HwPort) -> bool:
    return port in _ports(element) if isinstance(element, HwConnection) else port.container is element
