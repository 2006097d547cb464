"""Ticks described by statistics."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import DiscreteValueStatistics
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._ticks import is_read


def _check(element: DiscreteValueStatistics, context: Context) -> Iterator[str]:
    if is_read(element):
        yield "the statistics are changed to a normal distribution with an estimated standard deviation by am2inc"


RULE = ModelRule(
    id="INC-SW-TICKS-STAT",
    title="ticks described by statistics",
    severity=Severity.WARNING,
    target=DiscreteValueStatistics,
    check=_check,
    rationale="am2inc silently converts statistics to a normal distribution. As standard deviation it takes a third of the larger "
    "distance between the average and a bound, which nobody stated.",
    remedy="Use another distribution, e.g. boundaries with a sampling type or a Gaussian one.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueStatistics" lowerBound="1" upperBound="9" average="4"/>
      </items>
    </activityGraph>
  </runnables>
</swModel>
""",
    edits={
        'xsi:type="am:DiscreteValueStatistics"': 'xsi:type="am:DiscreteValueBoundaries"',
        'average="4"': 'samplingType="Uniform"',
    },
)
