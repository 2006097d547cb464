"""The protocol of event models: the maximum number of events in a window (eta+), and the minimum distance of events (delta-).

After K. Richter, "Compositional Scheduling Analysis Using Standard Event Models", TU Braunschweig, 2005. A window is half open: an
event at its end does not count.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from fractions import Fraction

from amalthea_uros.units import Time

#: Longer than any window: the distance to events that never occur.
NEVER: Time = 2**62


class EventModel(ABC):
    """Events whose density is bounded."""

    @abstractmethod
    def delta_min(self, count: int) -> Time:
        """Minimum time from the first to the last of `count` consecutive events (delta-)."""

    @property
    @abstractmethod
    def rate(self) -> Fraction:
        """Maximum number of events per time in the long run."""

    @property
    def max_interarrival(self) -> Time | None:
        """Maximum time between two consecutive events; None if it is unbounded or unknown."""
        return None

    @property
    def can_be_suppressed(self) -> bool:
        """Whether any of the events may not occur, so that their density is bounded from above only."""
        return False

    def eta_plus(self, window: Time) -> int:
        """Maximum number of events in a window of that length (eta+)."""
        if window <= 0:
            return 0
        above = 2
        while self.delta_min(above) < window:
            above *= 2
        below = above // 2
        # delta_min(below) < window <= delta_min(above); a single event always fits.
        while above - below > 1:
            middle = (below + above) // 2
            below, above = (middle, above) if self.delta_min(middle) < window else (below, middle)
        return below
