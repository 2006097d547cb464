"""Times in cells of tables."""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros.units import Rounding, Time, rounded_time_text, time_text

UNKNOWN = "unknown"


def at_most(value: Time | Fraction | None, limit: Time | None = None) -> str:
    """A maximum, rounded up, but not beyond the limit."""
    return UNKNOWN if value is None else rounded_time_text(value, Rounding.UP, limit)


def at_least(value: Time | Fraction | None) -> str:
    """A minimum, rounded down."""
    return UNKNOWN if value is None else rounded_time_text(value, Rounding.DOWN)


def about(value: Time | Fraction | None) -> str:
    """A mean."""
    return UNKNOWN if value is None else rounded_time_text(value, Rounding.NEAREST)


def deadline_text(deadline: Time | None, is_implicit: bool) -> str:
    """A deadline, and whether it is the period."""
    return "-" if deadline is None else f"{time_text(deadline)}{' (period)' if is_implicit else ''}"
