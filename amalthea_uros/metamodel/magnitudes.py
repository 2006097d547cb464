"""Quantities as exact numbers of one unit. Units without meaning, and quantities that are not given, give None."""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from fractions import Fraction
from math import isfinite
from typing import Any

from amalthea_uros.metamodel.classes.common import DataRate, DataSize, Frequency, Time
from amalthea_uros.metamodel.classes.enums import DataRateUnit, DataSizeUnit, FrequencyUnit, TimeUnit

#: Picoseconds.
TIMES = {TimeUnit.S: 10**12, TimeUnit.MS: 10**9, TimeUnit.US: 10**6, TimeUnit.NS: 10**3, TimeUnit.PS: 1}
#: Hertz.
FREQUENCIES = {FrequencyUnit.GHZ: 10**9, FrequencyUnit.MHZ: 10**6, FrequencyUnit.KHZ: 10**3, FrequencyUnit.HZ: 1}


def _data_factors(units: type[StrEnum]) -> dict[Any, int]:
    """Bits of a unit of data, by the prefix and the B or bit in its name."""
    found = {}
    for unit in units:
        word = unit.value.removesuffix("PerSecond")
        size = 8 if word.endswith("B") else 1
        prefix = word.removesuffix("B").removesuffix("bit")
        base, letter = (1024, prefix[:1]) if prefix.endswith("i") else (1000, prefix)
        if unit.value != "_undefined_":
            found[unit] = size * base ** " kMGT".upper().index(letter.upper() or " ")
    return found


#: Bits, and bits per second.
SIZES: Mapping[DataSizeUnit, int] = _data_factors(DataSizeUnit)
RATES: Mapping[DataRateUnit, int] = _data_factors(DataRateUnit)


def picoseconds(time: Time | None) -> int | None:
    """A time in picoseconds."""
    factor = TIMES.get(time.unit) if time is not None and time.unit is not None else None
    return None if time is None or factor is None else (time.value or 0) * factor


def hertz(frequency: Frequency | None) -> Fraction | None:
    """A frequency in hertz: the decimal number that stands in the file, not the binary one that is next to it."""
    factor = FREQUENCIES.get(frequency.unit) if frequency is not None and frequency.unit is not None else None
    if frequency is None or factor is None or not isfinite(frequency.value or 0.0):
        return None
    return Fraction(repr(frequency.value or 0.0)) * factor


def bits(size: DataSize | None) -> int | None:
    """A size in bits."""
    factor = SIZES.get(size.unit) if size is not None and size.unit is not None else None
    return None if size is None or factor is None else (size.value or 0) * factor


def bits_per_second(rate: DataRate | None) -> int | None:
    """A rate in bits per second."""
    factor = RATES.get(rate.unit) if rate is not None and rate.unit is not None else None
    return None if rate is None or factor is None else (rate.value or 0) * factor
