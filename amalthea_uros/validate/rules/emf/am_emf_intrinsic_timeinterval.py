"""Bounds of a time in the wrong order."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import TimeInterval
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.emf._intervals import disorder


def _check(element: TimeInterval, context: Context) -> Iterator[str]:
    yield from disorder(element)


RULE = ModelRule(
    id="AM-EMF-INTRINSIC/TimeInterval",
    title="bounds of a time in the wrong order",
    severity=Severity.ERROR,
    target=TimeInterval,
    check=_check,
    rationale="No value can satisfy these bounds. APP4MC's validation also reports it.",
    remedy="Correct the bounds or the average.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S">
    <jitter xsi:type="am:TimeUniformDistribution">
      <lowerBound value="3" unit="ms"/>
      <upperBound value="2" unit="ms"/>
    </jitter>
  </stimuli>
</stimuliModel>
""",
    edits={
        """<lowerBound value="3" unit="ms"/>
      <upperBound value="2" unit="ms"/>""": """<lowerBound value="2" unit="ms"/>
      <upperBound value="3" unit="ms"/>""",
    },
)
