"""Estimators that no Weibull distribution has."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import DiscreteValueWeibullEstimatorsDistribution
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: DiscreteValueWeibullEstimatorsDistribution, context: Context) -> Iterator[str]:
    names = ("lower_bound", "average", "upper_bound", "p_remain_promille")
    lower, average, upper, remaining = (element.effective(name) for name in names)
    if not lower < average < upper:
        yield f"the average {average} does not lie strictly between {lower} and {upper}"
    if not 0 < remaining < 1000:
        yield f"the probability of more than the upper bound is {remaining} per mille"


RULE = ModelRule(
    id="TIM-DISTRIBUTION",
    title="estimators that no Weibull distribution has",
    severity=Severity.WARNING,
    target=DiscreteValueWeibullEstimatorsDistribution,
    check=_check,
    rationale="A simulator draws something else, or nothing, so that its figures do not fit to those that are computed from the "
    "average and the bounds.",
    remedy="State an average strictly between the bounds, and a probability above 0 and below 1000 per mille.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueWeibullEstimatorsDistribution" lowerBound="10" upperBound="90" average="90"/>
      </items>
    </activityGraph>
  </runnables>
</swModel>
""",
    passes="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueWeibullEstimatorsDistribution" lowerBound="10" upperBound="90" average="50"/>
      </items>
    </activityGraph>
  </runnables>
</swModel>
""",
)
