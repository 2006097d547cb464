"""Invalid parameters of a Weibull distribution."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import DiscreteValueWeibullEstimatorsDistribution
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import runnable_with
from amalthea_uros.validate.rule import ModelRule


def _check(element: DiscreteValueWeibullEstimatorsDistribution, context: Context) -> Iterator[str]:
    names = ("lower_bound", "average", "upper_bound", "p_remain_promille")
    lower, average, upper, remaining = (element.effective(name) for name in names)
    if not lower < average < upper:
        yield f"the average {average} is not strictly between the bounds {lower} and {upper}"
    if not 0 < remaining < 1000:
        yield f"the probability of exceeding the upper bound is {remaining} per mille, but must be greater than 0 and less than 1000"


RULE = ModelRule(
    id="TIM-DISTRIBUTION",
    title="invalid parameters of a Weibull distribution",
    severity=Severity.WARNING,
    target=DiscreteValueWeibullEstimatorsDistribution,
    check=_check,
    rationale="A simulator has to replace the distribution, so its results do not match those computed from the average and "
    "the bounds.",
    remedy="Set an average strictly between the bounds, and a probability greater than 0 and less than 1000 per mille.",
    fails=runnable_with("""
<items xsi:type="am:Ticks">
  <default xsi:type="am:DiscreteValueWeibullEstimatorsDistribution" lowerBound="10" upperBound="90" average="90"/>
</items>
"""),
    edits={'average="90"': 'average="50"'},
)
