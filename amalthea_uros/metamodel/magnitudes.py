"""Quantities of AMALTHEA as exact numbers in the internal units of `amalthea_uros.units`.

In the other direction, a number becomes a quantity. A quantity that is not given gives None, and one whose unit
is undefined, unless it is 0.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from fractions import Fraction
from math import isfinite
from typing import TypeVar

from amalthea_uros import units
from amalthea_uros.metamodel.classes_common import DataRate, DataSize, Frequency, Time
from amalthea_uros.metamodel.classes_enums import DataRateUnit, DataSizeUnit, FrequencyUnit, TimeUnit

Unit = TypeVar("Unit", bound=StrEnum)


def _sizes(literals: type[Unit], dimension: units.Dimension) -> Mapping[Unit | None, int]:
    """The literals of an enumeration of units, largest first, with their sizes."""
    found = {unit: dimension.units[unit.value.replace("PerSecond", "/s")] for unit in literals if unit.name != "UNDEFINED"}
    return dict(sorted(found.items(), key=lambda item: -item[1]))


#: Picoseconds.
TIMES: Mapping[TimeUnit | None, int] = _sizes(TimeUnit, units.TIME)
#: Hertz.
FREQUENCIES: Mapping[FrequencyUnit | None, int] = _sizes(FrequencyUnit, units.FREQUENCY)
#: Bits, and bits per second.
SIZES: Mapping[DataSizeUnit | None, int] = _sizes(DataSizeUnit, units.DATA_SIZE)
RATES: Mapping[DataRateUnit | None, int] = _sizes(DataRateUnit, units.BIT_RATE)


def picoseconds(time: Time | None) -> int | None:
    """A time in picoseconds."""
    return None if time is None else _scaled(time.value, time.unit, TIMES)


def hertz(frequency: Frequency | None) -> Fraction | None:
    """A frequency in hertz: exactly the decimal number of the file, not the nearest binary one."""
    if frequency is None or frequency.unit not in FREQUENCIES or not isfinite(frequency.value or 0.0):
        return None
    return Fraction(repr(frequency.value or 0.0)) * FREQUENCIES[frequency.unit]


def time_of(value: int) -> Time:
    """Picoseconds in the largest unit that gives a whole number."""
    unit = next(unit for unit, size in TIMES.items() if value % size == 0) if value else TimeUnit.MS
    return Time(value=value // TIMES[unit], unit=unit)


def in_one_unit(*times: Time) -> bool:
    """State times in the finest of their units, in which all are whole numbers; returns whether all of them have one."""
    values = [picoseconds(time) for time in times]
    unit = min((time.unit for time in times if time.unit in TIMES), key=TIMES.__getitem__, default=None)
    if unit is None or None in values:
        return False
    for time, value in zip(times, values, strict=True):
        time.value, time.unit = (value or 0) // TIMES[unit], unit
    return True


def frequency_of(value: Fraction) -> Frequency | None:
    """Hertz in the largest unit in which it is at least 1; None if it has no exact decimal representation."""
    for unit, size in FREQUENCIES.items():
        number = value / size
        if (number >= 1 or size == 1) and Fraction(repr(float(number))) == number:
            return Frequency(value=float(number), unit=unit)
    return None


def bits(size: DataSize | None) -> int | None:
    """A data size in bits."""
    return None if size is None else _scaled(size.value, size.unit, SIZES)


def bits_per_second(rate: DataRate | None) -> int | None:
    """A data rate in bits per second."""
    return None if rate is None else _scaled(rate.value, rate.unit, RATES)


def _scaled(value: int | None, unit: Unit | None, sizes: Mapping[Unit | None, int]) -> int | None:
    size = sizes.get(unit)
    if size is None:
        # 0 is the same in any unit, if it is stated.
        return 0 if value == 0 else None
    return (value or 0) * size
