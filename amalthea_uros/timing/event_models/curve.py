"""Arrival curves: minimum distances for some numbers of events."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from amalthea_uros.timing.event_models.base import NEVER, EventModel
from amalthea_uros.units import Time


@dataclass(frozen=True)
class Curve(EventModel):
    """Events with given minimum distances for some counts.

    Attributes
    ----------
    distances : (count, minimum time from the first to the last of that many consecutive events)
    """

    distances: tuple[tuple[int, Time], ...]

    @cached_property
    def _densest(self) -> tuple[int, Time]:
        """The entry that bounds the long-run rate, as (count - 1, time)."""
        return max(((count - 1, time) for count, time in self.distances), key=lambda entry: Fraction(entry[1], entry[0]))

    def delta_min(self, count: int) -> Time:
        """See `EventModel`; distances add up over consecutive groups of events."""
        spacings, time = self._densest
        # The densest entry repeats; the rest is the best combination of entries.
        rounds, rest = divmod(max(0, count - 1), spacings)
        return rounds * time + self._combined[rest]

    @cached_property
    def _combined(self) -> list[Time]:
        """Minimum time of so many spacings between events, for fewer than the densest entry has."""
        best = [0]
        for reached in range(1, self._densest[0]):
            usable = [(count - 1, time) for count, time in self.distances if count - 1 <= reached]
            best.append(max((best[reached - spacing] + time for spacing, time in usable), default=best[reached - 1]))
        return best

    @property
    def rate(self) -> Fraction:
        """See `EventModel`."""
        spacings, time = self._densest
        return Fraction(spacings, time) if time else Fraction(NEVER)
