"""Missing bound of a Gauss distribution."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import DiscreteValueGaussDistribution
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._ticks import is_read


def _check(element: DiscreteValueGaussDistribution, context: Context) -> Iterator[str]:
    if (element.lower_bound is None or element.upper_bound is None) and is_read(element):
        yield "the Gauss distribution lacks a bound"


RULE = ModelRule(
    id="INC-SW-TICKS-GAUSS",
    title="missing bound of a Gauss distribution",
    severity=Severity.WARNING,
    target=DiscreteValueGaussDistribution,
    check=_check,
    rationale="am2inc cuts it to 0 without a word.",
    remedy="State both bounds.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueGaussDistribution" mean="5" sd="1"/>
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
