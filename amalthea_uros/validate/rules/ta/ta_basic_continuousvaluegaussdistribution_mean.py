"""Mean outside the bounds of a continuous Gauss distribution."""

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
    title="mean outside the bounds of a continuous Gauss distribution",
    severity=Severity.ERROR,
    target=ContinuousValueGaussDistribution,
    check=_check,
    rationale="A distribution that is truncated beside its peak rarely matches measured values. APP4MC's validation also reports it.",
    remedy="Choose a mean between the bounds.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:VariableRateStimulus" name="S">
    <step value="1" unit="s"/>
    <occurrencesPerStep xsi:type="am:ContinuousValueGaussDistribution" mean="0.5" sd="1" lowerBound="1" upperBound="9"/>
  </stimuli>
</stimuliModel>
""",
    edits={'mean="0.5"': 'mean="5"'},
)
