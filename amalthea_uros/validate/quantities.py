"""Bounds of deviations and clock frequencies as exact numbers, and quantities formatted for messages."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from decimal import Decimal
from fractions import Fraction

from amalthea_uros.metamodel.classes import (
    ContinuousValueConstant,
    ContinuousValueHistogram,
    DataSizeUnit,
    DiscreteValueConstant,
    DiscreteValueHistogram,
    IContinuousValueDeviation,
    IDiscreteValueDeviation,
    ITimeDeviation,
    ProcessingUnit,
    Time,
    TimeConstant,
    TimeHistogram,
    TimeUnit,
)
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.magnitudes import SIZES, TIMES, hertz, picoseconds

#: Units for messages, largest first.
_SIZES_SHOWN = ("GiB", "GB", "MiB", "MB", "KiB", "kB", "B", "bit")

Deviation = ITimeDeviation | IDiscreteValueDeviation | IContinuousValueDeviation


def clock(unit: ProcessingUnit) -> Fraction | None:
    """The clock frequency of a processing unit in hertz; None if it is unknown."""
    value = hertz(unit.frequency_domain.default_value) if unit.frequency_domain is not None else None
    return value if value is not None and value > 0 else None


def bounds(deviation: Deviation | None) -> tuple[float | None, float | None]:
    """The lower and upper bound, whole numbers exact, times in picoseconds; None for a missing bound."""
    match deviation:
        case None:
            return None, None
        case TimeConstant() | DiscreteValueConstant() | ContinuousValueConstant():
            value = _number(deviation, "value")
            return value, value
        case TimeHistogram() | DiscreteValueHistogram() | ContinuousValueHistogram():
            entries: Sequence[Element] = deviation.entries
            return _of_all(min, entries, "lower_bound"), _of_all(max, entries, "upper_bound")
    return _number(deviation, "lower_bound"), _number(deviation, "upper_bound")


def _of_all(choose: Callable[[Iterable[float]], float], entries: Sequence[Element], feature: str) -> float | None:
    values = [value for entry in entries if (value := _number(entry, feature)) is not None]
    return choose(values) if values and len(values) == len(entries) else None


def _number(element: Element, feature: str) -> float | None:
    value: Time | float | None = element.effective(feature)
    return picoseconds(value) if isinstance(value, Time) else value


def time_text(time: int | Fraction) -> str:
    """A time for messages, in the largest unit in which it is at least 1: `2.5 ms`."""
    value = Fraction(time)
    unit = next((unit for unit, size in TIMES.items() if abs(value) >= size), TimeUnit.S)
    return f"{number_text(value / TIMES[unit])} {unit}"


def size_text(size: int) -> str:
    """A data size for messages, in the largest unit that needs no decimals: `240 KiB`."""
    unit = next(unit for unit in map(DataSizeUnit, _SIZES_SHOWN) if size % SIZES[unit] == 0) if size else DataSizeUnit.B
    return f"{number_text(Fraction(size, SIZES[unit]))} {unit}"


def number_text(number: Fraction) -> str:
    """A number of any size with at most twelve digits."""
    # Quantities may exceed the range of float.
    return f"{Decimal(number.numerator) / Decimal(number.denominator):.12g}"
