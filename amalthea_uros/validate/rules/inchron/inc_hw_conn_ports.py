"""Connection that joins no initiator and responder."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwConnection
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: HwConnection, context: Context) -> Iterator[str]:
    types = {port.port_type for port in (element.port1, element.port2) if port is not None}
    if types != {"initiator", "responder"}:
        yield f"the connection {element.name!r} does not join an initiator and a responder"


RULE = ModelRule(
    id="INC-HW-CONN-PORTS",
    title="connection that joins no initiator and responder",
    severity=Severity.WARNING,
    target=HwConnection,
    check=_check,
    rationale="am2inc drops it without a word.",
    remedy="Join one port of the type initiator and one of the type responder.",
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
    passes="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <ports name="a" portType="initiator"/>
    <ports name="b" portType="responder"/>
    <connections name="wire" port1="ECU/a?type=HwPort" port2="ECU/b?type=HwPort"/>
  </structures>
</hwModel>
""",
)
