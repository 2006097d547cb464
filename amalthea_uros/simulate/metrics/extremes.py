"""The values that a constraint limits: the smallest and the greatest of many times, and when they were observed."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from fractions import Fraction
from typing import NamedTuple

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.judge.evidence import ObservedValues
from amalthea_uros.judge.limits import EventConstraint, SystemLimit, limits_of

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


@dataclass(slots=True)
class ConstraintMetrics(ABC):
    """The values that a constraint limits.

    Attributes
    ----------
    base : time units in a picosecond
    """

    constraint: EventConstraint
    base: int
    extremes: Extremes = field(init=False)

    def __post_init__(self) -> None:
        self.extremes = Extremes(self.base)

    @abstractmethod
    def add(self, times: Numbers, which: Numbers) -> None:
        """Take occurrences in, in the order of time, each with a number that says of what it is."""

    def quantities(self, end: int) -> Iterator[LimitedQuantity]:
        """What was observed up to the end of the run, in time units."""
        values = self._values(end)
        yield from (LimitedQuantity(limit, values) for limit in limits_of(self.constraint))

    @abstractmethod
    def _values(self, end: int) -> ObservedValues:
        """The values, and what is missing of them."""
