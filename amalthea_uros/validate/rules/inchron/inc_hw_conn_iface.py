"""Interconnect without a supported interface."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ConnectionHandler
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: ConnectionHandler, context: Context) -> Iterator[str]:
    if not element.ports or element.ports[0].port_interface not in ("AXI", "AHB", "APB", "custom"):
        yield f"the connection handler {element.name or ''!r} has no first port with the interface AXI, AHB, APB or custom"


RULE = ModelRule(
    id="INC-HW-CONN-IFACE",
    title="interconnect without a supported interface",
    severity=Severity.WARNING,
    target=ConnectionHandler,
    check=_check,
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
)
