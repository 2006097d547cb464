"""Frequency domain without a frequency."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import FrequencyDomain, ProcessingUnit
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._importer import amount


def _check(element: FrequencyDomain, context: Context) -> Iterator[str]:
    if context.uses(ProcessingUnit, "frequency_domain")[element] and not amount(element.default_value) > 0:
        yield f"the frequency domain {element.name!r} of a processing unit has no frequency above zero with a unit"


RULE = ModelRule(
    id="INC-HW-FREQ-VALUE",
    title="frequency domain without a frequency",
    severity=Severity.ERROR,
    target=FrequencyDomain,
    check=_check,
    rationale="am2inc ends with a segmentation fault, or takes 1000 MHz or 0 MHz without a word.",
    remedy="State a default value above zero, with its unit.",
    fails="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock"/>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core" frequencyDomain="clock?type=FrequencyDomain"/>
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
