"""Quantities of a model as exact numbers: times in picoseconds, sizes in bits, frequencies in hertz; and as text for people."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from math import isfinite

from amalthea_uros.metamodel.classes import (
    ContinuousValueConstant,
    ContinuousValueHistogram,
    DataSize,
    DataSizeUnit,
    DiscreteValueConstant,
    DiscreteValueHistogram,
    Frequency,
    FrequencyUnit,
    IContinuousValueDeviation,
    IDiscreteValueDeviation,
    ITimeDeviation,
    Time,
    TimeConstant,
    TimeHistogram,
    TimeUnit,
)
from amalthea_uros.metamodel.element import Element

_TIMES: dict[str, int] = {TimeUnit.S: 10**12, TimeUnit.MS: 10**9, TimeUnit.US: 10**6, TimeUnit.NS: 10**3, TimeUnit.PS: 1}
_FREQUENCIES: dict[str, int] = {
    FrequencyUnit.GHZ: 10**9,
    FrequencyUnit.MHZ: 10**6,
    FrequencyUnit.KHZ: 10**3,
    FrequencyUnit.HZ: 1,
}
_SIZES: dict[str, int] = {
    DataSizeUnit(f"{prefix}{unit}"): bits * factor
    for unit, bits in (("B", 8), ("bit", 1))
    for power, letter in enumerate(("", "k", "M", "G", "T"))
    for prefix, factor in ((letter, 1000**power), (letter and f"{letter.upper()}i", 1024**power))
}
#: Units for text, biggest first.
_SIZES_SHOWN = ("GiB", "GB", "MiB", "MB", "KiB", "kB", "B", "bit")

Deviation = ITimeDeviation | IDiscreteValueDeviation | IContinuousValueDeviation


def picoseconds(time: Time | None) -> int | None:
    """The value of a time; None if it has no unit."""
    factor = _factor(time, _TIMES)
    return None if time is None or factor is None else (time.value or 0) * factor


def bits(size: DataSize | None) -> int | None:
    """The value of a data size; None if it has no unit."""
    factor = _factor(size, _SIZES)
    return None if size is None or factor is None else (size.value or 0) * factor


def hertz(frequency: Frequency | None) -> Fraction | None:
    """The value of a frequency; None if it has no unit, or no value above zero."""
    factor = _factor(frequency, _FREQUENCIES)
    value = (frequency.value if frequency is not None else None) or 0.0
    # The decimal number that stands in the file, not the binary one that is next to it.
    return Fraction(repr(value)) * factor if factor is not None and isfinite(value) and value > 0 else None


def _factor(quantity: Time | DataSize | Frequency | None, units: Mapping[str, int]) -> int | None:
    return None if quantity is None or quantity.unit is None else units.get(quantity.unit)


def bounds(deviation: Deviation | None) -> tuple[float | None, float | None]:
    """The least and the greatest value, whole numbers exact, times in picoseconds; None where there is no bound."""
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
    """A time for people, in the biggest unit in which it is at least 1: `2.5 ms`."""
    value = Fraction(time)
    unit = next((unit for unit, size in _TIMES.items() if abs(value) >= size), TimeUnit.S)
    return f"{number_text(value / _TIMES[unit])} {unit}"


def size_text(size: int) -> str:
    """A data size for people, in the biggest unit that needs no decimals: `240 KiB`."""
    unit = next(unit for unit in map(DataSizeUnit, _SIZES_SHOWN) if size % _SIZES[unit] == 0) if size else DataSizeUnit.B
    return f"{number_text(Fraction(size, _SIZES[unit]))} {unit}"


def number_text(number: Fraction) -> str:
    """A number of any size with at most twelve digits."""
    # Quantities may be beyond the range of float.
    return f"{Decimal(number.numerator) / Decimal(number.denominator):.12g}"
