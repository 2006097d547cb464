"""Mean outside the bounds of a Gauss distribution of times."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import TimeGaussDistribution
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.ta._bounds import outside


def _check(element: TimeGaussDistribution, context: Context) -> Iterator[str]:
    yield from outside(element)


RULE = ModelRule(
    id="TA-Basic-TimeGaussDistribution-mean",
    title="mean outside the bounds of a Gauss distribution of times",
    severity=Severity.ERROR,
    target=TimeGaussDistribution,
    check=_check,
    rationale="A distribution that is truncated beside its peak rarely matches measured values. APP4MC's validation also reports it.",
    remedy="Choose a mean between the bounds.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S">
    <recurrence value="10" unit="ms"/>
    <jitter xsi:type="am:TimeGaussDistribution">
      <lowerBound value="0" unit="ms"/>
      <upperBound value="900" unit="us"/>
      <mean value="1" unit="ms"/>
      <sd value="100" unit="us"/>
    </jitter>
  </stimuli>
</stimuliModel>
""",
    edits={'value="900" unit="us"': 'value="2" unit="ms"'},
)
