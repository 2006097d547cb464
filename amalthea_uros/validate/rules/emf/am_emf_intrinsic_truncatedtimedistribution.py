"""Bounds of a time distribution in the wrong order."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import TruncatedTimeDistribution
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.emf._intervals import disorder


def _check(element: TruncatedTimeDistribution, context: Context) -> Iterator[str]:
    yield from disorder(element)


RULE = ModelRule(
    id="AM-EMF-INTRINSIC/TruncatedTimeDistribution",
    title="bounds of a time distribution in the wrong order",
    severity=Severity.ERROR,
    target=TruncatedTimeDistribution,
    check=_check,
    rationale="No value can satisfy these bounds. APP4MC's validation also reports it.",
    remedy="Correct the bounds.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S">
    <jitter xsi:type="am:TimeGaussDistribution">
      <mean value="2" unit="ms"/>
      <sd value="1" unit="ms"/>
      <lowerBound value="3" unit="ms"/>
      <upperBound value="1" unit="ms"/>
    </jitter>
  </stimuli>
</stimuliModel>
""",
    edits={
        'value="3"': 'value="1"',
        '<upperBound value="1"': '<upperBound value="3"',
    },
)
