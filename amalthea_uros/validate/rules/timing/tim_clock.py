"""Processing unit whose clock is not known."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ProcessingUnit
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.quantities import clock
from amalthea_uros.validate.rule import ModelRule


def _check(element: ProcessingUnit, context: Context) -> Iterator[str]:
    if clock(element) is None:
        yield f"the clock of {element.name!r} is not known"


RULE = ModelRule(
    id="TIM-CLOCK",
    title="processing unit whose clock is not known",
    severity=Severity.WARNING,
    target=ProcessingUnit,
    check=_check,
    rationale="Without a frequency no tick becomes a time, and nothing on this processing unit can be analysed.",
    remedy="Give it a frequency domain with a default value and a unit, or state the clock with --frequency.",
    fails="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core"/>
  </structures>
</hwModel>
""",
    passes="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core" frequencyDomain="clock?type=FrequencyDomain"/>
  </structures>
</hwModel>
""",
)
