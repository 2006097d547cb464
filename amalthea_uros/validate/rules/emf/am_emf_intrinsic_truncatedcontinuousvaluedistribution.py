"""Bounds of a continuous distribution in the wrong order."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import TruncatedContinuousValueDistribution
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.emf._intervals import disorder


def _check(element: TruncatedContinuousValueDistribution, context: Context) -> Iterator[str]:
    yield from disorder(element)


RULE = ModelRule(
    id="AM-EMF-INTRINSIC/TruncatedContinuousValueDistribution",
    title="bounds of a continuous distribution in the wrong order",
    severity=Severity.ERROR,
    target=TruncatedContinuousValueDistribution,
    check=_check,
    rationale="No value can satisfy these bounds. APP4MC's validation also reports it.",
    remedy="Correct the bounds.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:VariableRateStimulus" name="S">
    <occurrencesPerStep xsi:type="am:ContinuousValueGaussDistribution" lowerBound="2.0" upperBound="1.5" mean="1.75" sd="1.0"/>
  </stimuli>
</stimuliModel>
""",
    edits={'lowerBound="2.0" upperBound="1.5"': 'lowerBound="1.5" upperBound="2.0"'},
)
