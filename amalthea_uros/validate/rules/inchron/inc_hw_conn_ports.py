"""Incomplete port or connection."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwConnection, HwModule, HwPort
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: HwConnection | HwPort, context: Context) -> Iterator[str]:
    if isinstance(element, HwConnection):
        types = {port.port_type for port in (element.port1, element.port2) if port is not None}
        if types != {"initiator", "responder"}:
            yield f"the connection {element.name or ''!r} does not join an initiator and a responder port"
    if isinstance(element, HwPort) and isinstance(element.container, HwModule) and element.port_type in (None, "_undefined_"):
        yield f"the port {element.name or ''!r} of {element.container.name or ''!r} has no port type"


RULE = ModelRule(
    id="INC-HW-CONN-PORTS",
    title="incomplete port or connection",
    severity=Severity.WARNING,
    target=(HwConnection, HwPort),
    check=_check,
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
)
