"""Bounds of deviations and clocks as exact numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.magnitudes import hertz, picoseconds

Deviation = am.ITimeDeviation | am.IDiscreteValueDeviation | am.IContinuousValueDeviation


def clock(unit: am.ProcessingUnit) -> Fraction | None:
    """The clock frequency of a processing unit in hertz; None if it is unknown."""
    value = hertz(unit.frequency_domain.default_value) if unit.frequency_domain is not None else None
    return value if value is not None and value > 0 else None


def bounds(deviation: Deviation | None) -> tuple[float | None, float | None]:
    """The lower and upper bound, whole numbers exact, times in picoseconds; None for a missing bound."""
    match deviation:
        case None:
            return None, None
        case am.TimeConstant() | am.DiscreteValueConstant() | am.ContinuousValueConstant():
            value = _number(deviation, "value")
            return value, value
        case am.TimeHistogram() | am.DiscreteValueHistogram() | am.ContinuousValueHistogram():
            entries: Sequence[Element] = deviation.entries
            return _of_all(min, entries, "lower_bound"), _of_all(max, entries, "upper_bound")
    return _number(deviation, "lower_bound"), _number(deviation, "upper_bound")


def _of_all(choose: Callable[[Iterable[float]], float], entries: Sequence[Element], feature: str) -> float | None:
    values = [value for entry in entries if (value := _number(entry, feature)) is not None]
    return choose(values) if values and len(values) == len(entries) else None


def _number(element: Element, feature: str) -> float | None:
    value: am.Time | float | None = element.effective(feature)
    return picoseconds(value) if isinstance(value, am.Time) else value
