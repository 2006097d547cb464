"""Bursts and other repeating lists of events."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from amalthea_uros.timing.event_models.base import EventModel
from amalthea_uros.units import Time


@dataclass(frozen=True)
class Pattern(EventModel):
    """A list of events that repeats with a period.

    Attributes
    ----------
    times : ascending, within the period
    longest_at_start : the maximum time between two events while some of the list do not occur yet
    """

    period: Time
    times: tuple[Time, ...]
    longest_at_start: Time = 0

    def delta_min(self, count: int) -> Time:
        """See `EventModel`."""
        if count < 2:
            return 0
        rounds, distances = divmod(count - 1, len(self.times))
        return rounds * self.period + self._shortest[distances]

    def eta_plus(self, window: Time) -> int:
        """See `EventModel`."""
        if window <= 0:
            return 0
        rounds, rest = divmod(window - 1, self.period)
        return rounds * len(self.times) + bisect_right(self._shortest, rest)

    @cached_property
    def _shortest(self) -> list[Time]:
        """Minimum time of so many consecutive distances, for less than one period."""
        twice = (*self.times, *(time + self.period for time in self.times))
        length = len(self.times)
        return [min(twice[i + distances] - twice[i] for i in range(length)) for distances in range(length)]

    @property
    def rate(self) -> Fraction:
        """See `EventModel`."""
        return Fraction(len(self.times), self.period)

    @property
    def max_interarrival(self) -> Time:
        """See `EventModel`."""
        ends = (*self.times[1:], self.times[0] + self.period)
        return max(self.longest_at_start, *(end - start for start, end in zip(self.times, ends, strict=True)))
