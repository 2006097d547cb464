"""Port without a bit width."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwModule, HwPort
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: HwPort, context: Context) -> Iterator[str]:
    if isinstance(element.container, HwModule) and not (element.bit_width or 0) > 0:
        yield f"the port {element.name or ''!r} of {element.container.name or ''!r} has no positive bit width"


RULE = ModelRule(
    id="INC-HW-BITWIDTH",
    title="port without a bit width",
    severity=Severity.WARNING,
    target=HwPort,
    check=_check,
    rationale="am2inc takes the width of the core, memory or interconnect from its ports.",
    remedy="Set a bit width greater than 0.",
    fails="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:Memory" name="RAM">
      <ports name="p"/>
    </modules>
  </structures>
</hwModel>
""",
    edits={'name="p"': 'name="p" bitWidth="32"'},
)
