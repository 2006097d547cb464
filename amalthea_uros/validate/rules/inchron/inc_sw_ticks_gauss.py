"""Unbounded Gaussian distribution."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import DiscreteValueGaussDistribution
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._missing import missing
from amalthea_uros.validate.rules.inchron._ticks import is_read


def _check(element: DiscreteValueGaussDistribution, context: Context) -> Iterator[str]:
    absent = missing({"lower bound": element.lower_bound, "upper bound": element.upper_bound})
    if absent and is_read(element):
        yield f"the Gaussian distribution has no {absent}"


RULE = ModelRule(
    id="INC-SW-TICKS-GAUSS",
    title="unbounded Gaussian distribution",
    severity=Severity.WARNING,
    target=DiscreteValueGaussDistribution,
    check=_check,
    rationale="am2inc silently truncates the distribution to 0.",
    remedy="Set both bounds.",
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
    edits={'sd="1"': 'sd="1" lowerBound="1" upperBound="9"'},
)
