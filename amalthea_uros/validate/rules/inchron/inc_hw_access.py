"""Access that carries timing."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwAccessElement
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: HwAccessElement, context: Context) -> Iterator[str]:
    yield f"what accesses to {element.destination.name if element.destination else 'a memory'!r} cost is ignored"


RULE = ModelRule(
    id="INC-HW-ACCESS",
    title="access that carries timing",
    severity=Severity.WARNING,
    target=HwAccessElement,
    check=_check,
    rationale="am2inc ignores access elements, paths and latencies without a word.",
    remedy="Do not rely on the timing of memory accesses after the import.",
    fails="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core">
      <accessElements name="a"/>
    </modules>
  </structures>
</hwModel>
""",
    passes="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core"/>
  </structures>
</hwModel>
""",
)
