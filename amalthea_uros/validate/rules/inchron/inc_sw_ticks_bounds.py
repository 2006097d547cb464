"""Boundaries with the default sampling type."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import DiscreteValueBoundaries
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._ticks import is_read


def _check(element: DiscreteValueBoundaries, context: Context) -> Iterator[str]:
    if element.sampling_type in (None, "default") and is_read(element):
        yield "the boundaries use the default sampling type"


RULE = ModelRule(
    id="INC-SW-TICKS-BOUNDS",
    title="boundaries with the default sampling type",
    severity=Severity.WARNING,
    target=DiscreteValueBoundaries,
    check=_check,
    rationale="am2inc silently computes a wrong mean, which can be less than the lower bound.",
    remedy="Set the sampling type to BestCase, WorstCase, AverageCase, CornerCase or Uniform.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueBoundaries" lowerBound="1" upperBound="9"/>
      </items>
    </activityGraph>
  </runnables>
</swModel>
""",
    edits={'upperBound="9"': 'upperBound="9" samplingType="Uniform"'},
)
