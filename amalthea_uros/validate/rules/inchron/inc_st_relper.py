"""Relative periodic stimulus that is not converted."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import RelativePeriodicStimulus, TimeGaussDistribution, TimeUniformDistribution
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: RelativePeriodicStimulus, context: Context) -> Iterator[str]:
    if not isinstance(element.next_occurrence, TimeGaussDistribution | TimeUniformDistribution):
        yield f"the next occurrence of {element.name!r} is neither uniform nor Gauss"


RULE = ModelRule(
    id="INC-ST-RELPER",
    title="relative periodic stimulus that is not converted",
    severity=Severity.ERROR,
    target=RelativePeriodicStimulus,
    check=_check,
    rationale="The conversion is aborted; without any distance it takes a period of 0 without a word.",
    remedy="State the next occurrence as a uniform or Gauss distribution.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:RelativePeriodicStimulus" name="S"/>
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
