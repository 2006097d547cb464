"""Times that callers of the library state: each with its unit."""

from __future__ import annotations

from collections.abc import Callable
from datetime import timedelta
from decimal import Decimal
from fractions import Fraction
from typing import TypeAlias

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.units import MICROSECOND, TIME, Duration, Time, parse_time, time_text

#: Text with a unit, such as "5 ms", a `Duration`, a `timedelta`, or a number, also one of numpy, if its unit is stated beside it.
TimeLike: TypeAlias = str | Duration | timedelta | float | Fraction | Decimal


def stated_time(
    what: str,
    value: TimeLike,
    unit: str | None = None,
    rounding: Callable[[Fraction], int] = round,
    least: Time | None = None,
    remedy: str = "a Duration",
) -> Time:
    """Whole picoseconds of a time.

    Parameters
    ----------
    what : the name of the value, for messages
    unit : of numbers; without it, the only number is 0, which is the same time in every unit
    rounding : to which side fractions of a picosecond are rounded
    remedy : what else than a text can be written in place of a number without a unit

    Raises
    ------
    InvalidArgumentError : no time, a number without a unit, or a time below `least`.
    """
    time = _picoseconds(what, value, unit, rounding, remedy)
    if least is not None and time < least:
        raise InvalidArgumentError(f"{what}: {time_text(time)} is {'not positive' if least else 'negative'}")
    return time


class KeptTime(int):
    """Whole picoseconds of a time that was stated with its unit, so that it need not be when an object is copied."""

    __slots__ = ()


def kept_time(what: str, value: TimeLike) -> KeptTime:
    """Whole picoseconds of a time; raises as `stated_time`."""
    return value if isinstance(value, KeptTime) else KeptTime(stated_time(what, value))


def _picoseconds(what: str, value: TimeLike, unit: str | None, rounding: Callable[[Fraction], int], remedy: str) -> Time:
    if unit is not None and unit not in TIME.units:
        raise InvalidArgumentError(f"{unit!r} is not a unit of time; known units: {', '.join(TIME.units)}")
    match value:
        case Duration():
            return value.time
        case timedelta():
            return value // timedelta(microseconds=1) * MICROSECOND
        case str():
            try:
                return parse_time(value)
            except ValueError as error:
                raise InvalidArgumentError(f"{what}: {error}") from None
    number = _number(what, value)
    if unit is not None:
        return rounding(number * TIME.units[unit])
    if number:
        raise InvalidArgumentError(
            f"{what}: the number {value} has no unit; write a text such as '{_example(value)}', or {remedy}"
        )
    return 0


def _example(value: object) -> str:
    """The number in milliseconds; a large one is probably a result, which is in picoseconds."""
    text = str(value)
    return f"{text} ms" if len(text) < 8 else f"{text} ps"


def _number(what: str, value: object) -> Fraction:
    """The number that somebody wrote: 0.1 is a tenth, and not the nearest binary fraction."""
    try:
        if isinstance(value, bool):
            raise TypeError
        return Fraction(value if isinstance(value, Fraction | Decimal) else str(value))
    except (OverflowError, ValueError, TypeError, ZeroDivisionError):
        raise InvalidArgumentError(f"{what}: expected a time such as '10 ms', not {value!r}") from None
