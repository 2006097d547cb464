"""Ports and connections of hardware."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ConnectionHandler, HwConnection, HwModule, HwPort, HwStructure, PortInterface
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


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


def _check_connection(element: HwConnection, context: Context) -> Iterator[str]:
    first, second = element.port1, element.port2
    for name, port in (("port1", first), ("port2", second)):
        if port is None:
            yield f"connection {element.name!r} has no {name}"
    if first is None or second is None:
        return
    if first is second:
        yield f"connection {element.name!r} connects a port to itself"
    elif not is_internal(element):
        interfaces = {first.port_interface, second.port_interface} - {None, PortInterface.UNDEFINED}
        if len(interfaces) > 1:
            yield f"connection {element.name!r} connects different interfaces: {' and '.join(sorted(map(str, interfaces)))}"


def _check_connections(element: HwPort, context: Context) -> Iterator[str]:
    count = context.once(connections_outside)[element]
    if count > 1 and not isinstance(element.container, HwStructure):
        yield f"port {element.qualified_name!r} has {count} connections, but at most 1 is allowed"


def _check_definition(element: HwPort, context: Context) -> Iterator[str]:
    for feature in ("port_type", "port_interface"):
        if getattr(element, feature) in (None, "_undefined_"):
            yield f"port {element.name!r} has no {feature.replace('_', ' ')}"


def _check_single_connection(element: HwPort, context: Context) -> Iterator[str]:
    count = context.once(connections_outside)[element]
    most = 2 if isinstance(element.container, HwStructure) else 1
    if count > most:
        yield f"port {element.qualified_name!r} has {count} connections, but at most {most} {'is' if most == 1 else 'are'} allowed"


RULES = (
    ModelRule(
        id="AM-HW-Connection",
        title="invalid hardware connection",
        severity=Severity.ERROR,
        target=HwConnection,
        check=_check_connection,
        rationale="No data can be transferred over such a connection. APP4MC's validation also reports it.",
        remedy="Connect two different ports with the same interface.",
        fails="""
<hwModel>
  <structures name="ECU">
    <connections name="wire"/>
  </structures>
</hwModel>
""",
        edits={
            '<connections name="wire"/>': """<ports name="a" portInterface="AXI"/>
    <ports name="b" portInterface="AXI"/>
    <connections name="wire" port1="ECU/a?type=HwPort" port2="ECU/b?type=HwPort"/>""",
        },
    ),
    ModelRule(
        id="AM-HW-Port",
        title="port with several connections",
        severity=Severity.ERROR,
        target=HwPort,
        check=_check_connections,
        rationale="A connection links exactly two ports; only a connection handler can link more. APP4MC's validation also reports it.",
        remedy="Use a separate port for each connection, or insert a connection handler.",
        fails="""
<hwModel>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core">
      <ports name="p"/>
    </modules>
    <modules xsi:type="am:Memory" name="RAM">
      <ports name="p"/>
      <ports name="q"/>
    </modules>
    <connections name="a" port1="core/p?type=HwPort" port2="RAM/p?type=HwPort"/>
    <connections name="b" port1="core/p?type=HwPort" port2="RAM/q?type=HwPort"/>
  </structures>
</hwModel>
""",
        edits={
            """</modules>
    <modules xsi:type="am:Memory" name="RAM">""": """  <ports name="q"/>
    </modules>
    <modules xsi:type="am:Memory" name="RAM">""",
            'name="b" port1="core/p?type=HwPort"': 'name="b" port1="core/q?type=HwPort"',
        },
    ),
    ModelRule(
        id="AM-HW-Port-Definition",
        title="port without a type or interface",
        severity=Severity.WARNING,
        target=HwPort,
        check=_check_definition,
        rationale="Without a type and an interface, connections to the port cannot be checked. APP4MC's validation also reports it.",
        remedy="Set the port type and the port interface.",
        fails="""
<hwModel>
  <structures name="ECU">
    <ports name="a"/>
  </structures>
</hwModel>
""",
        edits={'name="a"': 'name="a" portType="initiator" portInterface="AXI"'},
    ),
    ModelRule(
        id="DOC-HwPort-Single-Connection",
        title="too many connections at a port",
        severity=Severity.ERROR,
        target=HwPort,
        check=_check_single_connection,
        rationale="A port of a structure has one outer and one inner connection, any other port only one; connections inside "
        "connection handlers are not counted. The APP4MC documentation requires this.",
        remedy="Use a separate port for each connection, or insert a connection handler.",
        fails="""
<hwModel>
  <structures name="ECU">
    <ports name="p"/>
    <modules xsi:type="am:Memory" name="RAM">
      <ports name="a"/>
      <ports name="b"/>
      <ports name="c"/>
    </modules>
    <connections name="x" port1="ECU/p?type=HwPort" port2="RAM/a?type=HwPort"/>
    <connections name="y" port1="ECU/p?type=HwPort" port2="RAM/b?type=HwPort"/>
    <connections name="z" port1="ECU/p?type=HwPort" port2="RAM/c?type=HwPort"/>
  </structures>
</hwModel>
""",
        edits={'    <connections name="z" port1="ECU/p?type=HwPort" port2="RAM/c?type=HwPort"/>\n': ""},
    ),
)
