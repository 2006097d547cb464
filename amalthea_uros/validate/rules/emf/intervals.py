"""The order of the bounds and the average of a deviation."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.magnitudes import picoseconds
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import model_rule


@model_rule("AM-EMF-INTRINSIC/ContinuousValueInterval", am.ContinuousValueInterval)
@model_rule("AM-EMF-INTRINSIC/DiscreteValueInterval", am.DiscreteValueInterval)
@model_rule("AM-EMF-INTRINSIC/TimeInterval", am.TimeInterval)
@model_rule("AM-EMF-INTRINSIC/TruncatedContinuousValueDistribution", am.TruncatedContinuousValueDistribution)
@model_rule("AM-EMF-INTRINSIC/TruncatedDiscreteValueDistribution", am.TruncatedDiscreteValueDistribution)
@model_rule("AM-EMF-INTRINSIC/TruncatedTimeDistribution", am.TruncatedTimeDistribution)
def _check_intervals(element: Element, context: Context) -> Iterator[str]:
    """Compare the lower bound, the average and the upper bound; missing values are skipped."""
    values = [(words, getattr(element, name, None)) for name, words in _NAMES.items()]
    if values[1][1] is not None:
        yield from _decreasing(values)
    yield from _decreasing([values[0], values[2]])


_NAMES = {"lower_bound": "lower bound", "average": "average", "upper_bound": "upper bound"}


def _decreasing(values: list[tuple[str, am.Time | float | None]]) -> Iterator[str]:
    for (words, value), (next_words, next_value) in pairwise(values):
        number, next_number = _number(value), _number(next_value)
        if number is not None and next_number is not None and number > next_number:
            yield f"the {words} {_shown(value)} is above the {next_words} {_shown(next_value)}"


def _number(value: am.Time | float | None) -> float | None:
    return picoseconds(value) if isinstance(value, am.Time) else value


def _shown(value: am.Time | float | None) -> str:
    return f"{value.value or 0} {value.unit}" if isinstance(value, am.Time) else str(value)


@model_rule("AM-EMF-INTRINSIC/MinAvgMaxStatistic", am.MinAvgMaxStatistic)
def _check_minavgmaxstatistic(element: am.MinAvgMaxStatistic, context: Context) -> Iterator[str]:
    least, average, most = (element.effective(name) for name in ("min", "avg", "max"))
    if not least <= average <= most:
        yield f"the average {average} is not between the minimum {least} and the maximum {most}"
