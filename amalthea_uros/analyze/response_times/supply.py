"""How much of a processor a scheduler gets: all of it, or what a server grants.

The supply of a server is bounded as that of a periodic resource (I. Shin and I. Lee, "Periodic resource model for compositional
real-time guarantees", RTSS 2003; R. I. Davis and A. Burns, "Hierarchical fixed priority pre-emptive scheduling", RTSS 2005).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True)
class Full:
    """All of the processor's time.

    Attributes
    ----------
    rate : the share of the processor in the long run
    """

    rate: ClassVar[Fraction] = Fraction(1)

    def time_for(self, demand: Time) -> Time:
        """The longest time until so much demand has been served."""
        return demand


@dataclass(frozen=True, slots=True, kw_only=True)
class Budget:
    """A budget in each period.

    Attributes
    ----------
    wait : the longest time without any supply, in front of the first budget
    """

    budget: Time
    period: Time
    wait: Time

    @property
    def rate(self) -> Fraction:
        """See `Full`."""
        return Fraction(self.budget, self.period)

    def time_for(self, demand: Time) -> Time:
        """See `Full`; behind the first budget, one more gap comes with each further one that is needed."""
        if demand <= 0:
            return 0
        gaps = -(-demand // self.budget) - 1
        return self.wait + gaps * (self.period - self.budget) + demand


Supply = Full | Budget
FULL = Full()
