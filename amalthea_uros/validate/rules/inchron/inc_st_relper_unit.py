"""Bounds in different units."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import RelativePeriodicStimulus, TimeUniformDistribution
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: RelativePeriodicStimulus, context: Context) -> Iterator[str]:
    distance = element.next_occurrence
    bounds = [distance.lower_bound, distance.upper_bound] if isinstance(distance, TimeUniformDistribution) else []
    if len({bound.unit for bound in bounds if bound is not None}) > 1:
        yield f"the bounds of the next occurrence of {element.name!r} have different units"


RULE = ModelRule(
    id="INC-ST-RELPER-UNIT",
    title="bounds in different units",
    severity=Severity.WARNING,
    target=RelativePeriodicStimulus,
    check=_check,
    rationale="The value is wrong by powers of 1000, without a word.",
    remedy="State both bounds in the same unit.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:RelativePeriodicStimulus" name="S">
    <nextOccurrence xsi:type="am:TimeUniformDistribution">
      <lowerBound value="1" unit="ms"/>
      <upperBound value="2000" unit="us"/>
    </nextOccurrence>
  </stimuli>
</stimuliModel>
""",
    passes="""
<stimuliModel>
  <stimuli xsi:type="am:RelativePeriodicStimulus" name="S">
    <nextOccurrence xsi:type="am:TimeUniformDistribution">
      <lowerBound value="1" unit="ms"/>
      <upperBound value="2" unit="ms"/>
    </nextOccurrence>
  </stimuli>
</stimuliModel>
""",
)
