"""Ports and connection handlers of hardware."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ConnectionHandler, HwConnection, HwModule, HwPort
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check_handler(element: ConnectionHandler, context: Context) -> Iterator[str]:
    if not element.ports or element.ports[0].port_interface not in ("AXI", "AHB", "APB", "custom"):
        yield f"the connection handler {element.name or ''!r} has no first port with the interface AXI, AHB, APB or custom"


def _check_ports(element: HwConnection | HwPort, context: Context) -> Iterator[str]:
    if isinstance(element, HwConnection):
        types = {port.port_type for port in (element.port1, element.port2) if port is not None}
        if types != {"initiator", "responder"}:
            yield f"the connection {element.name or ''!r} does not join an initiator and a responder port"
    if isinstance(element, HwPort) and isinstance(element.container, HwModule) and element.port_type in (None, "_undefined_"):
        yield f"the port {element.name or ''!r} of {element.container.name or ''!r} has no port type"


RULES = (
    ModelRule(
        id="INC-HW-CONN-IFACE",
        title="interconnect without a supported interface",
        severity=Severity.WARNING,
        target=ConnectionHandler,
        check=_check_handler,
        rationale="am2inc silently drops the connection handler.",
        remedy="Give the connection handler a port, and set the interface of its first port to AXI, AHB, APB or custom.",
        fails="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:ConnectionHandler" name="bus">
      <ports name="p" portInterface="CAN"/>
    </modules>
  </structures>
</hwModel>
""",
        edits={'portInterface="CAN"': 'portInterface="AXI"'},
    ),
    ModelRule(
        id="INC-HW-CONN-PORTS",
        title="incomplete port or connection",
        severity=Severity.WARNING,
        target=(HwConnection, HwPort),
        check=_check_ports,
        rationale="am2inc silently drops ports without a type, and connections that do not join one initiator and one responder.",
        remedy="Set the type of every port, and connect one initiator to one responder.",
        fails="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <ports name="a" portType="initiator"/>
    <ports name="b" portType="initiator"/>
    <connections name="wire" port1="ECU/a?type=HwPort" port2="ECU/b?type=HwPort"/>
  </structures>
</hwModel>
""",
        edits={'name="b" portType="initiator"': 'name="b" portType="responder"'},
    ),
)
