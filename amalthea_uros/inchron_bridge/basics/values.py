"""Quantities: a whole number in the internal unit, and an object with a number and a unit."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.units import DATA_SIZE, FREQUENCY, Frequency, Time

_TIMES: dict[str, int] = {"s": 10**12, "ms": 10**9, "us": 10**6, "ns": 10**3, "ps": 1}
#: Binary prefixes have a small k in projects.
_SIZES = {unit.replace("Ki", "ki"): bits for unit, bits in DATA_SIZE.units.items()}
_FREQUENCIES: Mapping[str, int] = FREQUENCY.units

#: What stands for "no limit" where an interval needs an upper one: the longest time that fits.
NO_LIMIT: Time = 2**63 - 1


def time(value: int, unit: str | None = None) -> ProjectObject:
    """A time in picoseconds; the number of a project is whole, so that the unit must be small enough.

    Parameters
    ----------
    unit : as it is spelled in a model; otherwise the largest one in which the number is whole
    """
    if unit not in _TIMES or value % _TIMES[unit]:
        unit = next(each for each, size in _TIMES.items() if value % size == 0) if value else "ps"
    return ProjectObject("Time", value=value // _TIMES[unit], unit=unit)


def time_of(item: ProjectObject | None) -> Time | None:
    """Picoseconds; None for no time, for ticks, and for fractions of a picosecond."""
    if item is None:
        return None
    if item["unit"] == "fs":
        return None if item["value"] % 1000 else int(item["value"]) // 1000
    return int(item["value"]) * _TIMES[item["unit"]] if item["unit"] in _TIMES else None


def ticks(value: int) -> ProjectObject:
    """A number of ticks of the clock of a core."""
    return ProjectObject("Time", value=value, unit="T")


def size(bits: int, unit: str | None = None) -> ProjectObject:
    """A data size."""
    unit = {"KiB": "kiB", "Kibit": "kibit"}.get(unit or "", unit)
    if unit not in _SIZES or bits % _SIZES[unit]:
        unit = next(each for each in ("MiB", "kiB", "B", "bit") if bits % _SIZES[each] == 0) if bits else "B"
    return ProjectObject("DataSize", value=bits // _SIZES[unit], unit=unit)


def size_of(item: ProjectObject | None) -> int | None:
    """Bits."""
    return None if item is None else int(item["value"]) * _SIZES[item["unit"]]


def frequency(value: Frequency, unit: str | None = None) -> ProjectObject:
    """A frequency."""
    if unit is None or unit not in _FREQUENCIES:
        unit = next((each for each, hertz in reversed(tuple(_FREQUENCIES.items())) if value >= hertz), "Hz")
    return ProjectObject("Frequency", value=float(value / _FREQUENCIES[unit]), unit=unit)


def frequency_of(item: ProjectObject | None) -> Frequency | None:
    """Hertz; the decimal number that is written, exactly."""
    return None if item is None else Fraction(repr(float(item["value"]))) * _FREQUENCIES[item["unit"]]
