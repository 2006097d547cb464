"""The order of two values: a mean and a bound, or a minimum and a maximum."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

from amalthea_uros.metamodel.classes import (
    ContinuousValueGaussDistribution,
    DiscreteValueGaussDistribution,
    Time,
    TimeGaussDistribution,
)
from amalthea_uros.metamodel.magnitudes import picoseconds
from amalthea_uros.units import time_text


def outside(gauss: DiscreteValueGaussDistribution | ContinuousValueGaussDistribution | TimeGaussDistribution) -> Iterator[str]:
    """Messages about a mean outside its bounds; missing and non-finite values are skipped."""
    mean, lower, upper = (_value(gauss.effective(name)) for name in ("mean", "lower_bound", "upper_bound"))
    if mean is not None and lower is not None and mean < lower:
        yield f"the mean {_text(gauss.mean)} is below the lower bound {_text(gauss.lower_bound)}"
    if mean is not None and upper is not None and mean > upper:
        yield f"the mean {_text(gauss.mean)} is above the upper bound {_text(gauss.upper_bound)}"


def _value(value: Time | float | None) -> float | None:
    number = picoseconds(value) if isinstance(value, Time) else value
    return number if number is not None and isfinite(number) else None


def _text(value: Time | float | None) -> str:
    return time_text(picoseconds(value) or 0) if isinstance(value, Time) else str(value or 0)


def reversed_times(what: str, lower: Time | None, upper: Time | None) -> Iterator[str]:
    """A message about a minimum time above the maximum; times without a unit are not compared."""
    minimum, maximum = picoseconds(lower), picoseconds(upper)
    if minimum is not None and maximum is not None and minimum > maximum:
        yield f"the minimum {what} {time_text(minimum)} is above the maximum {what} {time_text(maximum)}"
