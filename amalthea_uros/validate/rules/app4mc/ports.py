"""Ports, connections, access paths and structures of hardware."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import pairwise

from amalthea_uros._internal.plural import counted
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.magnitudes import bits
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import model_rule


def is_internal(connection: am.HwConnection) -> bool:
    """Whether a connection belongs to a connection handler."""
    return isinstance(connection.container, am.ConnectionHandler)


def connections_outside(context: Context) -> Counter[am.HwPort]:
    """The number of connections at each port, not counting those inside connection handlers."""
    return Counter(
        port for connection in context.all(am.HwConnection) if not is_internal(connection) for port in set(_ports(connection))
    )


def share_no_port(first: Element, second: Element) -> bool:
    """Whether two connections or modules certainly have no port in common; False if one of them is unresolved."""
    if first.unresolved is not None or second.unresolved is not None:
        return False
    if isinstance(second, am.HwConnection):  # it has two ports, a module may have many
        first, second = second, first
    return not any(_has(second, port) for port in _ports(first))


def _ports(element: Element) -> list[am.HwPort]:
    if isinstance(element, am.HwConnection):
        return [port for port in (element.port1, element.port2) if port is not None]
    return element.ports if isinstance(element, am.HwModule) else []


def _has(element: Element, port: am.HwPort) -> bool:
    return port in _ports(element) if isinstance(element, am.HwConnection) else port.container is element


@model_rule("AM-HW-Connection", am.HwConnection)
def _check_connection(element: am.HwConnection, context: Context) -> Iterator[str]:
    first, second = element.port1, element.port2
    for name, port in (("port1", first), ("port2", second)):
        if port is None:
            yield f"connection {element.name!r} has no {name}"
    if first is None or second is None:
        return
    if first is second:
        yield f"connection {element.name!r} connects a port to itself"
    elif not is_internal(element):
        interfaces = {first.port_interface, second.port_interface} - {None, am.PortInterface.UNDEFINED}
        if len(interfaces) > 1:
            yield f"connection {element.name!r} connects different interfaces: {' and '.join(sorted(map(str, interfaces)))}"


@model_rule("AM-HW-Port", am.HwPort)
def _check_connections(element: am.HwPort, context: Context) -> Iterator[str]:
    count = context.once(connections_outside)[element]
    if count > 1 and not isinstance(element.container, am.HwStructure):
        yield f"port {element.qualified_name!r} has {count} connections, but at most 1 is allowed"


@model_rule("AM-HW-Port-Definition", am.HwPort)
def _check_definition(element: am.HwPort, context: Context) -> Iterator[str]:
    for feature in ("port_type", "port_interface"):
        if getattr(element, feature) in (None, "_undefined_"):
            yield f"port {element.name!r} has no {feature.replace('_', ' ')}"


@model_rule("DOC-HwPort-Single-Connection", am.HwPort)
def _check_single_connection(element: am.HwPort, context: Context) -> Iterator[str]:
    count = context.once(connections_outside)[element]
    most = 2 if isinstance(element.container, am.HwStructure) else 1
    if count > most:
        yield f"port {element.qualified_name!r} has {count} connections, but at most {most} {'is' if most == 1 else 'are'} allowed"


@model_rule("AM-HW-AccessPath", am.HwAccessPath)
def _check_accesspath(element: am.HwAccessPath, context: Context) -> Iterator[str]:
    access = element.container
    destination = access.destination if isinstance(access, am.HwAccessElement) else None
    yield from _addresses(element, destination)
    if element.path_elements:
        source = access.container if access is not None else None
        yield from _end(element.path_elements[0], source, "start")
        if destination is None:
            yield "the path has no destination"
        yield from _end(element.path_elements[-1], destination, "end")
        for first, second in pairwise(element.path_elements):
            if share_no_port(first, second):
                yield f"{first.qualified_name!r} and {second.qualified_name!r} are adjacent, but share no port"


def _addresses(path: am.HwAccessPath, destination: am.HwDestination | None) -> Iterator[str]:
    start, end, offset = (path.start_address or 0), (path.end_address or 0), (path.mem_offset or 0)
    if end < start:
        yield f"the end address {end:#x} is below the start address {start:#x}"
    if not isinstance(destination, am.Memory) or destination.unresolved is not None:
        return
    if destination.definition is None:
        yield f"the destination memory {destination.name!r} has no definition"
        return
    size = bits(destination.definition.size)
    if size is not None and start <= end and 8 * (offset + end - start) > size:
        yield f"{end - start:#x} bytes at offset {offset:#x} exceed the {size // 8:#x} bytes of {destination.name!r}"


def _end(element: am.HwPathElement, neighbour: Element | None, which: str) -> Iterator[str]:
    if element.unresolved is not None:
        return
    if not isinstance(element, am.HwConnection):
        yield f"{element.qualified_name!r} at the {which} of the path is not a connection"
    elif neighbour is not None and share_no_port(element, neighbour):
        yield f"connection {element.name!r} at the {which} of the path has no port of {neighbour.qualified_name!r}"


_TYPES = (am.PortType.INITIATOR, am.PortType.RESPONDER)


@model_rule("AM-HW-Structure", am.HwConnection)
def _check_structure(element: am.HwConnection, context: Context) -> Iterator[str]:
    structure, first, second = element.container, element.port1, element.port2
    if not isinstance(structure, am.HwStructure) or first is None or second is None or first is second:
        return
    if not {first.port_type, second.port_type}.issubset(_TYPES):
        return
    outer = {_is_outer(first, structure), _is_outer(second, structure)}
    if outer == {True, False} and first.port_type != second.port_type:
        yield f"connection {element.name!r} delegates between ports of type {first.port_type} and {second.port_type}"
    elif outer in ({True}, {False}) and first.port_type == second.port_type:
        yield f"connection {element.name!r} connects two ports of type {first.port_type}"


def _is_outer(port: am.HwPort, structure: am.HwStructure) -> bool | None:
    """True for a port of the structure itself, False for a port of its direct parts, None for any other port."""
    holder = port.container
    if holder is structure:
        return True
    if holder is not None and isinstance(holder.container, am.ProcessingUnit):
        holder = holder.container  # the port belongs to a cache
    return False if holder is not None and holder.container is structure else None


@model_rule("DOC-ConnectionHandler-Transfers", am.ConnectionHandlerDefinition)
def _check_connectionhandler_transfers(element: am.ConnectionHandlerDefinition, context: Context) -> Iterator[str]:
    transfers = element.max_concurrent_transfers
    for handler in context.once(_handlers).get(element, []):
        count = Counter(port.port_type for port in handler.ports)
        if transfers is not None and handler.ports and count.keys() <= set(_TYPES):
            fewest = min(_TYPES, key=count.__getitem__)
            if transfers > count[fewest]:
                ports = counted(count[fewest], f"{fewest} port")
                yield f"{handler.name!r} has {ports}, too few for {counted(transfers, 'concurrent transfer')}"


def _handlers(context: Context) -> dict[am.ConnectionHandlerDefinition, list[am.ConnectionHandler]]:
    found: dict[am.ConnectionHandlerDefinition, list[am.ConnectionHandler]] = {}
    for handler in context.all(am.ConnectionHandler):
        if handler.definition is not None:
            found.setdefault(handler.definition, []).append(handler)
    return found
