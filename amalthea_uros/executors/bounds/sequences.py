"""How long several cycles of an executor take that follow each other.

What the loop of its thread does in intervals of its own, such as a ping every second, is not in each cycle: it begins again after the
interval at the earliest, so that at most 1 + t // interval of n cycles that take t contain it. If L is the longest cycle with it, and U
the longest one without it, n cycles take at most the least

    t = n U + min(n, sum over the intervals of (1 + t // interval)) (L - U)
"""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros._internal.records import dataclass
from amalthea_uros.units import Time

#: After which all cycles count as the longest ones.
_STEPS = 100


@dataclass(frozen=True, slots=True)
class CycleSequence:
    """Cycles that follow each other.

    Attributes
    ----------
    longest, usual : bounds of a cycle, and of one without what is done in intervals
    intervals : of what is done in them
    """

    longest: Time
    usual: Time
    intervals: tuple[Time, ...] = ()

    def time(self, count: int) -> Time:
        """The longest time of some cycles."""
        rare = min(count, len(self.intervals))
        for _ in range(_STEPS):
            time = count * self.usual + rare * (self.longest - self.usual)
            begun = min(count, sum(1 + time // each for each in self.intervals))
            if begun <= rare:
                return time
            rare = begun
        return count * self.longest

    @property
    def average(self) -> Fraction:
        """The longest time of a cycle in the long run."""
        share = (self.longest - self.usual) * sum(Fraction(1, each) for each in self.intervals)
        return min(Fraction(self.longest), Fraction(self.usual) / (1 - share)) if share < 1 else Fraction(self.longest)
