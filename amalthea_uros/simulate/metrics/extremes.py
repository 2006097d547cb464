"""The smallest and the greatest of many times, and when they were observed."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros.judge.evidence import ObservedValues
from amalthea_uros.judge.limits import SystemLimit

#: So many occurrences are kept that wait for a corresponding one; what corresponds to older ones is not evaluated.
WINDOW = 2**16


class LimitedQuantity(NamedTuple):
    """A limit, and what was observed of the quantity."""

    limit: SystemLimit
    values: ObservedValues


@dataclass(slots=True)
class Extremes:
    """Extremes of times.

    Attributes
    ----------
    base : time units in a picosecond
    low, high : the values, each with the time at which it was observed first; None before any value
    """

    base: int
    low: tuple[int, int] | None = None
    high: tuple[int, int] | None = None

    def add(self, values: Numbers, times: Numbers) -> None:
        """Take values in, and when each was observed."""
        if len(values) == 0:
            return
        lowest, highest = int(values.argmin()), int(values.argmax())
        if self.low is None or values[lowest] < self.low[0]:
            self.low = int(values[lowest]), int(times[lowest])
        if self.high is None or values[highest] > self.high[0]:
            self.high = int(values[highest]), int(times[highest])

    def limited(self, reason: str, pending: int = 0, is_complete: bool = True) -> ObservedValues:
        """The extremes in picoseconds, or the reason why there are none, or not all of them."""
        if self.low is None or self.high is None:
            return ObservedValues(pending=Fraction(pending, self.base), reason=reason)
        return ObservedValues(
            low=Fraction(self.low[0], self.base),
            high=Fraction(self.high[0], self.base),
            pending=Fraction(pending, self.base),
            is_complete=is_complete,
            reason="" if is_complete else reason,
            low_at=Fraction(self.low[1], self.base),
            high_at=Fraction(self.high[1], self.base),
        )
