"""Processing unit without a clock frequency."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ProcessingUnit
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.quantities import clock
from amalthea_uros.validate.rule import ModelRule


def _check(element: ProcessingUnit, context: Context) -> Iterator[str]:
    if clock(element) is None:
        yield f"the clock frequency of {element.name!r} is unknown"


RULE = ModelRule(
    id="TIM-CLOCK",
    title="processing unit without a clock frequency",
    severity=Severity.WARNING,
    target=ProcessingUnit,
    check=_check,
    rationale="Ticks cannot be converted into times, so nothing on this processing unit can be analysed.",
    remedy="Add a frequency domain with a default value and a unit, or set the frequency with --frequency.",
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
    edits={'name="core"': 'name="core" frequencyDomain="clock?type=FrequencyDomain"'},
)
