"""Mean outside the bounds of a discrete Gauss distribution."""

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
    title="mean outside the bounds of a discrete Gauss distribution",
    severity=Severity.ERROR,
    target=DiscreteValueGaussDistribution,
    check=_check,
    rationale="A distribution that is truncated beside its peak rarely matches measured values. APP4MC's validation also reports it.",
    remedy="Choose a mean between the bounds.",
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
    edits={'mean="9.5"': 'mean="5"'},
)
