"""Two values that are in a certain order."""

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
    """Whether the mean is beyond a bound; what is not given, or no number, is beyond nothing."""
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
    """Whether a least time is above the greatest one; times without a unit are not compared."""
    least, greatest = picoseconds(lower), picoseconds(upper)
    if least is not None and greatest is not None and least > greatest:
        yield f"the {what} is at least {time_text(least)} and at most {time_text(greatest)}"
