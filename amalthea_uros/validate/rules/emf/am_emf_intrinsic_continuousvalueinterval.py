"""Bounds of a continuous value in the wrong order."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ContinuousValueInterval
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.emf._intervals import disorder


def _check(element: ContinuousValueInterval, context: Context) -> Iterator[str]:
    yield from disorder(element)


RULE = ModelRule(
    id="AM-EMF-INTRINSIC/ContinuousValueInterval",
    title="bounds of a continuous value in the wrong order",
    severity=Severity.ERROR,
    target=ContinuousValueInterval,
    check=_check,
    rationale="No value can satisfy these bounds. APP4MC's validation also reports it.",
    remedy="Correct the bounds or the average.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:VariableRateStimulus" name="S">
    <occurrencesPerStep xsi:type="am:ContinuousValueBoundaries" lowerBound="2.0" upperBound="1.5"/>
  </stimuli>
</stimuliModel>
""",
    edits={'lowerBound="2.0" upperBound="1.5"': 'lowerBound="1.5" upperBound="2.0"'},
)
