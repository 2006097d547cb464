"""Processing unit without a clock."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ProcessingUnit
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: ProcessingUnit, context: Context) -> Iterator[str]:
    if element.frequency_domain is None:
        yield f"the processing unit {element.name or ''!r} has no frequency domain"


RULE = ModelRule(
    id="INC-HW-PU-CLOCK",
    title="processing unit without a clock",
    severity=Severity.ERROR,
    target=ProcessingUnit,
    check=_check,
    rationale="am2inc crashes with a segmentation fault.",
    remedy="Give the processing unit a frequency domain.",
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
