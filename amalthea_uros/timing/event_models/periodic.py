"""Periodic and sporadic events, and events that occur once."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from amalthea_uros.timing.event_models.base import NEVER, EventModel
from amalthea_uros.units import Time


@dataclass(frozen=True)
class Periodic(EventModel):
    """Periodic events with jitter and a minimum distance."""

    period: Time
    jitter: Time = 0
    min_interarrival: Time = 0

    def delta_min(self, count: int) -> Time:
        """See `EventModel`."""
        return max(0, (count - 1) * self.min_interarrival, (count - 1) * self.period - self.jitter) if count > 1 else 0

    def eta_plus(self, window: Time) -> int:
        """See `EventModel`."""
        if window <= 0:
            return 0
        count = -(-(window + self.jitter) // self.period)
        return min(count, -(-window // self.min_interarrival)) if self.min_interarrival else count

    @property
    def rate(self) -> Fraction:
        """See `EventModel`."""
        return Fraction(1, self.period)

    @property
    def max_interarrival(self) -> Time | None:
        """See `EventModel`."""
        return self.period + self.jitter


@dataclass(frozen=True)
class Sporadic(Periodic):
    """Events with a minimum distance that can also be less frequent.

    Attributes
    ----------
    longest : maximum time between two events; None if it is unknown
    """

    longest: Time | None = None

    @property
    def max_interarrival(self) -> Time | None:
        """See `EventModel`."""
        return self.longest


@dataclass(frozen=True)
class Conditional(Sporadic):
    """Periodic or sporadic events, each of which occurs only if a condition is true."""

    @property
    def can_be_suppressed(self) -> bool:
        """See `EventModel`."""
        return True


def is_strictly_periodic(model: EventModel) -> bool:
    """Whether an event occurs in every period, with or without jitter."""
    return isinstance(model, Periodic) and not isinstance(model, Sporadic)


def can_be_dense(model: EventModel) -> bool:
    """Whether the minimum distances are known to occur, not only bounds."""
    return isinstance(model, Periodic) and not model.can_be_suppressed


@dataclass(frozen=True)
class Single(EventModel):
    """One event."""

    def delta_min(self, count: int) -> Time:
        """See `EventModel`."""
        return 0 if count < 2 else NEVER

    @property
    def rate(self) -> Fraction:
        """See `EventModel`."""
        return Fraction(0)
