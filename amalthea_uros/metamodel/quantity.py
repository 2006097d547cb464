"""Units of the AMALTHEA quantities, given by name: `Time(10, "ms")`."""

from __future__ import annotations

from enum import StrEnum
from typing import TypeVar

Unit = TypeVar("Unit", bound=StrEnum)


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
