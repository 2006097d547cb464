"""Event models: the maximum number of events in a window (eta+), and the minimum distance of events (delta-).

After K. Richter, "Compositional Scheduling Analysis Using Standard Event Models", TU Braunschweig, 2005. A window is half open: an
event at its end does not count.

These are those of stimuli: periodic and sporadic events, patterns such as bursts, arrival curves, and single events.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from bisect import bisect_right
from fractions import Fraction
from functools import cached_property

from amalthea_uros._internal.records import dataclass
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


@dataclass(frozen=True)
class PeriodicEvents(EventModel):
    """Periodic events with jitter and a minimum distance."""

    period: Time
    jitter: Time = 0
    min_interarrival: Time = 0

    def delta_min(self, count: int) -> Time:
        return max(0, (count - 1) * self.min_interarrival, (count - 1) * self.period - self.jitter) if count > 1 else 0

    def eta_plus(self, window: Time) -> int:
        if window <= 0:
            return 0
        count = -(-(window + self.jitter) // self.period)
        return min(count, -(-window // self.min_interarrival)) if self.min_interarrival else count

    @property
    def close_together(self) -> int:
        """Number of events, from the first one on, that can be as close together as the minimum distance allows."""
        if self.period <= self.min_interarrival:
            return NEVER
        return -(-self.jitter // (self.period - self.min_interarrival))

    @property
    def rate(self) -> Fraction:
        return Fraction(1, self.period)

    @property
    def max_interarrival(self) -> Time | None:
        return self.period + self.jitter


@dataclass(frozen=True)
class SporadicEvents(PeriodicEvents):
    """Events with a minimum distance that can also be less frequent.

    Attributes
    ----------
    longest : maximum time between two events; None if it is unknown
    """

    longest: Time | None = None

    @property
    def max_interarrival(self) -> Time | None:
        return self.longest


@dataclass(frozen=True)
class ConditionalEvents(SporadicEvents):
    """Periodic or sporadic events, each of which occurs only if a condition is true."""

    @property
    def can_be_suppressed(self) -> bool:
        return True


def is_strictly_periodic(model: EventModel) -> bool:
    """Whether an event occurs in every period, with or without jitter."""
    return isinstance(model, PeriodicEvents) and not isinstance(model, SporadicEvents)


def can_be_dense(model: EventModel) -> bool:
    """Whether the minimum distances are known to occur, not only bounds."""
    return isinstance(model, PeriodicEvents) and not model.can_be_suppressed


@dataclass(frozen=True)
class SingleEvent(EventModel):
    """One event."""

    def delta_min(self, count: int) -> Time:
        return 0 if count < 2 else NEVER

    @property
    def rate(self) -> Fraction:
        return Fraction(0)


@dataclass(frozen=True)
class EventPattern(EventModel):
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
        if count < 2:
            return 0
        rounds, distances = divmod(count - 1, len(self.times))
        return rounds * self.period + self._shortest[distances]

    def eta_plus(self, window: Time) -> int:
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
        return Fraction(len(self.times), self.period)

    @property
    def max_interarrival(self) -> Time:
        ends = (*self.times[1:], self.times[0] + self.period)
        return max(self.longest_at_start, *(end - start for start, end in zip(self.times, ends, strict=True)))


@dataclass(frozen=True)
class MinimumDistances(EventModel):
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
        """Distances add up over consecutive groups of events."""
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
        spacings, time = self._densest
        return Fraction(spacings, time) if time else Fraction(NEVER)
