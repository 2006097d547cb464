"""Mean of a Gauss distribution of whole numbers that is outside of its bounds."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import DiscreteValueGaussDistribution
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.ta._bounds import outside


def _check(element: DiscreteValueGaussDistribution, context: Context) -> Iterator[str]:
    yield from outside(element)


RULE = ModelRule(
    id="TA-Basic-DiscreteValueGaussDistribution-mean",
    title="mean outside of the bounds",
    severity=Severity.ERROR,
    target=DiscreteValueGaussDistribution,
    check=_check,
    rationale="A distribution that is cut off beside its peak is hardly what was measured. APP4MC reports it when it validates "
    "the model.",
    remedy="Put the mean between the bounds.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueGaussDistribution" mean="9.5" sd="1" lowerBound="1" upperBound="9"/>
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
        <default xsi:type="am:DiscreteValueGaussDistribution" mean="5" sd="1" lowerBound="1" upperBound="9"/>
      </items>
    </activityGraph>
  </runnables>
</swModel>
""",
)
