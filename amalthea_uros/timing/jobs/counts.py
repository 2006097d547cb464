"""How often an activity is executed where the model states a number, as for calls of runnables and accesses to labels."""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from math import isfinite

from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import Count
from amalthea_uros.units import down, up

#: Minimum, mean and maximum number of a single execution.
_ONCE = (1, Fraction(1), 1)


def count_of(times: Count | float | None) -> tuple[int, Fraction, int]:
    """Minimum, mean and maximum number of executions that one activity of the model represents.

    Raises
    ------
    UnknownError : they are negative or in the wrong order, as if only a mean is stated and the maximum is 0.
    """
    if times is None:
        return _ONCE
    try:
        number = Fraction(1 if isinstance(times, Count) else times)
        found = (
            (times.least, Fraction(times.mean), times.most) if isinstance(times, Count) else (down(number), number, up(number))
        )
    except (ValueError, OverflowError):
        raise UnknownError("a number of calls or accesses is not finite") from None
    if not 0 <= found[0] <= found[1] <= found[2]:
        raise UnknownError("a number of calls or accesses is negative, or its mean is not between its minimum and maximum")
    return found


def is_average(times: Count | float | None) -> bool:
    """Whether a number is an average without bounds: it is usually measured, and a fraction can be nothing else."""
    return isinstance(times, float) and isfinite(times) and not times.is_integer()


@lru_cache(maxsize=1024)
def bounds_of(times: Count | float | None) -> tuple[int, int | None]:
    """The least number of executions, and the greatest one; None if it is unknown."""
    if times is None:
        return 1, 1
    try:
        least, _, most = count_of(times)
    except UnknownError:
        return 0, None
    return (0, None) if is_average(times) else (least, most)
