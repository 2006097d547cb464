"""Bounds of a discrete distribution in the wrong order."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import TruncatedDiscreteValueDistribution
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.emf._intervals import disorder


def _check(element: TruncatedDiscreteValueDistribution, context: Context) -> Iterator[str]:
    yield from disorder(element)


RULE = ModelRule(
    id="AM-EMF-INTRINSIC/TruncatedDiscreteValueDistribution",
    title="bounds of a discrete distribution in the wrong order",
    severity=Severity.ERROR,
    target=TruncatedDiscreteValueDistribution,
    check=_check,
    rationale="No value can satisfy these bounds. APP4MC's validation also reports it.",
    remedy="Correct the bounds.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueGaussDistribution" lowerBound="20" upperBound="10" mean="15.0" sd="1.0"/>
      </items>
    </activityGraph>
  </runnables>
</swModel>
""",
    edits={'lowerBound="20" upperBound="10"': 'lowerBound="10" upperBound="20"'},
)
