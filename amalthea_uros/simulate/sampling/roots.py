"""The root of a function of one variable."""

from __future__ import annotations

from collections.abc import Callable

_STEPS = 100


def root(function: Callable[[float], float], low: float, high: float) -> float:
    """Where a function changes its sign between two points, by the Illinois method (M. Dowell, P. Jarratt, BIT 11, 1971)."""
    at_low, at_high = function(low), function(high)
    for _ in range(_STEPS):
        if at_low == at_high:
            break
        middle = high - at_high * (high - low) / (at_high - at_low)
        found = function(middle)
        if found == 0 or abs(high - low) <= 1e-14 * (abs(low) + abs(high)):
            return middle
        if (found < 0) != (at_high < 0):
            low, at_low = high, at_high
        else:
            at_low /= 2
        high, at_high = middle, found
    return high
