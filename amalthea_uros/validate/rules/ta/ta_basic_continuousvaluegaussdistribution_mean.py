"""Mean of a Gauss distribution of numbers that is outside of its bounds."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ContinuousValueGaussDistribution
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.ta._bounds import outside


def _check(element: ContinuousValueGaussDistribution, context: Context) -> Iterator[str]:
    yield from outside(element)


RULE = ModelRule(
    id="TA-Basic-ContinuousValueGaussDistribution-mean",
    title="mean outside of the bounds",
    severity=Severity.ERROR,
    target=ContinuousValueGaussDistribution,
    check=_check,
    rationale="A distribution that is cut off beside its peak is hardly what was measured. APP4MC reports it when it validates "
    "the model.",
    remedy="Put the mean between the bounds.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:VariableRateStimulus" name="S">
    <step value="1" unit="s"/>
    <occurrencesPerStep xsi:type="am:ContinuousValueGaussDistribution" mean="0.5" sd="1" lowerBound="1" upperBound="9"/>
  </stimuli>
</stimuliModel>
""",
    passes="""
<stimuliModel>
  <stimuli xsi:type="am:VariableRateStimulus" name="S">
    <step value="1" unit="s"/>
    <occurrencesPerStep xsi:type="am:ContinuousValueGaussDistribution" mean="5" sd="1" lowerBound="1" upperBound="9"/>
  </stimuli>
</stimuliModel>
""",
)
