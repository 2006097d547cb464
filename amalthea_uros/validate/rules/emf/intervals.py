"""The order of the bounds and the average of a deviation."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    ContinuousValueInterval,
    DiscreteValueInterval,
    Time,
    TimeInterval,
    TruncatedContinuousValueDistribution,
    TruncatedDiscreteValueDistribution,
    TruncatedTimeDistribution,
)
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.magnitudes import picoseconds
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import runnable_with
from amalthea_uros.validate.rule import ModelRule


def _check(element: Element, context: Context) -> Iterator[str]:
    """Compare the lower bound, the average and the upper bound; missing values are skipped."""
    values = [(words, getattr(element, name, None)) for name, words in _NAMES.items()]
    if values[1][1] is not None:
        yield from _decreasing(values)
    yield from _decreasing([values[0], values[2]])


_NAMES = {"lower_bound": "lower bound", "average": "average", "upper_bound": "upper bound"}


def _decreasing(values: list[tuple[str, Time | float | None]]) -> Iterator[str]:
    for (words, value), (next_words, next_value) in pairwise(values):
        number, next_number = _number(value), _number(next_value)
        if number is not None and next_number is not None and number > next_number:
            yield f"the {words} {_shown(value)} is above the {next_words} {_shown(next_value)}"


def _number(value: Time | float | None) -> float | None:
    return picoseconds(value) if isinstance(value, Time) else value


def _shown(value: Time | float | None) -> str:
    return f"{value.value or 0} {value.unit}" if isinstance(value, Time) else str(value)


_RATIONALE = "No value can satisfy these bounds. APP4MC's validation also reports it."

RULES = (
    ModelRule(
        id="AM-EMF-INTRINSIC/ContinuousValueInterval",
        title="bounds of a continuous value in the wrong order",
        severity=Severity.ERROR,
        target=ContinuousValueInterval,
        check=_check,
        rationale=_RATIONALE,
        remedy="Correct the bounds or the average.",
        fails="""
<stimuliModel>
  <stimuli xsi:type="am:VariableRateStimulus" name="S">
    <occurrencesPerStep xsi:type="am:ContinuousValueBoundaries" lowerBound="2.0" upperBound="1.5"/>
  </stimuli>
</stimuliModel>
""",
        edits={'lowerBound="2.0" upperBound="1.5"': 'lowerBound="1.5" upperBound="2.0"'},
    ),
    ModelRule(
        id="AM-EMF-INTRINSIC/DiscreteValueInterval",
        title="bounds of a discrete value in the wrong order",
        severity=Severity.ERROR,
        target=DiscreteValueInterval,
        check=_check,
        rationale=_RATIONALE,
        remedy="Correct the bounds or the average.",
        fails=runnable_with("""
<items xsi:type="am:Ticks">
  <default xsi:type="am:DiscreteValueBoundaries" lowerBound="20" upperBound="10"/>
</items>
"""),
        edits={'lowerBound="20" upperBound="10"': 'lowerBound="10" upperBound="20"'},
    ),
    ModelRule(
        id="AM-EMF-INTRINSIC/TimeInterval",
        title="bounds of a time in the wrong order",
        severity=Severity.ERROR,
        target=TimeInterval,
        check=_check,
        rationale=_RATIONALE,
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
    ),
    ModelRule(
        id="AM-EMF-INTRINSIC/TruncatedContinuousValueDistribution",
        title="bounds of a continuous distribution in the wrong order",
        severity=Severity.ERROR,
        target=TruncatedContinuousValueDistribution,
        check=_check,
        rationale=_RATIONALE,
        remedy="Correct the bounds.",
        fails="""
<stimuliModel>
  <stimuli xsi:type="am:VariableRateStimulus" name="S">
    <occurrencesPerStep xsi:type="am:ContinuousValueGaussDistribution" lowerBound="2.0" upperBound="1.5" mean="1.75" sd="1.0"/>
  </stimuli>
</stimuliModel>
""",
        edits={'lowerBound="2.0" upperBound="1.5"': 'lowerBound="1.5" upperBound="2.0"'},
    ),
    ModelRule(
        id="AM-EMF-INTRINSIC/TruncatedDiscreteValueDistribution",
        title="bounds of a discrete distribution in the wrong order",
        severity=Severity.ERROR,
        target=TruncatedDiscreteValueDistribution,
        check=_check,
        rationale=_RATIONALE,
        remedy="Correct the bounds.",
        fails=runnable_with("""
<items xsi:type="am:Ticks">
  <default xsi:type="am:DiscreteValueGaussDistribution" lowerBound="20" upperBound="10" mean="15.0" sd="1.0"/>
</items>
"""),
        edits={'lowerBound="20" upperBound="10"': 'lowerBound="10" upperBound="20"'},
    ),
    ModelRule(
        id="AM-EMF-INTRINSIC/TruncatedTimeDistribution",
        title="bounds of a time distribution in the wrong order",
        severity=Severity.ERROR,
        target=TruncatedTimeDistribution,
        check=_check,
        rationale=_RATIONALE,
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
    ),
)
