"""Units of the AMALTHEA quantities, given by name: `Time(10, "ms")`."""

from __future__ import annotations

from enum import StrEnum
from typing import TypeVar

Unit = TypeVar("Unit", bound=StrEnum)
Number = TypeVar("Number", bound=float | None)


def number_of(given: Number) -> Number:
    """The number of a quantity.

    Raises
    ------
    TypeError : a text was given, such as "2 ms".
    """
    if isinstance(given, str):
        raise TypeError(f"expected a number and a unit, e.g. Time(2, 'ms'), not the text {given!r}; parse_time() reads texts")
    return given


def unit_of(units: type[Unit], given: Unit | str | None) -> Unit | None:
    """The unit of that name.

    Raises
    ------
    ValueError : no such unit; the text lists those that exist.
    """
    try:
        return None if given is None else units(given)
    except ValueError:
        known = ", ".join(unit.value for unit in units if unit.name != "UNDEFINED")
        raise ValueError(f"unknown unit {given!r}, expected one of {known}") from None
