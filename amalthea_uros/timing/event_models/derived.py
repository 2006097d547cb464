"""Event models that are derived from others.

Several sources, every n-th event, another unit of time, delayed events, completions of jobs.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from itertools import accumulate

from amalthea_uros._internal.records import dataclass
from amalthea_uros.timing.event_models.models import (
    NEVER,
    ConditionalEvents,
    EventModel,
    PeriodicEvents,
    SporadicEvents,
)
from amalthea_uros.units import Time


@dataclass(frozen=True)
class AggregatedEventModel(EventModel):
    """Events of several independent sources."""

    sources: tuple[EventModel, ...]

    def eta_plus(self, window: Time) -> int:
        return sum(source.eta_plus(window) for source in self.sources)

    def delta_min(self, count: int) -> Time:
        if count not in self._distances:
            self._distances[count] = self._delta_min(count)
        return self._distances[count]

    @cached_property
    def _distances(self) -> dict[int, Time]:
        """Cached results; busy windows need the same ones many times."""
        return {}

    def _delta_min(self, count: int) -> Time:
        if count <= 1 or self.eta_plus(1) >= count:
            return 0
        above = 1
        while self.eta_plus(above + 1) < count:
            above *= 2
            if above >= NEVER:
                return NEVER
        below = above // 2
        while above - below > 1:
            middle = (below + above) // 2
            below, above = (below, middle) if self.eta_plus(middle + 1) >= count else (middle, above)
        return above

    @property
    def rate(self) -> Fraction:
        return sum((source.rate for source in self.sources), Fraction(0))

    @property
    def can_be_suppressed(self) -> bool:
        return any(source.can_be_suppressed for source in self.sources)


def aggregated(sources: tuple[EventModel, ...]) -> EventModel:
    """The events of all sources; the same model for a single source."""
    return sources[0] if len(sources) == 1 else AggregatedEventModel(sources)


@dataclass(frozen=True)
class DerivedEvents(EventModel):
    """Events that follow from those of another model, as many in the long run unless a subclass says otherwise."""

    events: EventModel

    @property
    def rate(self) -> Fraction:
        return self.events.rate

    @property
    def can_be_suppressed(self) -> bool:
        return self.events.can_be_suppressed


@dataclass(frozen=True)
class Multiplied(DerivedEvents):
    """Several events for each event of another model, simultaneous in the worst case."""

    factor: int

    def delta_min(self, count: int) -> Time:
        return self.events.delta_min(-(-count // self.factor))

    def eta_plus(self, window: Time) -> int:
        return self.factor * self.events.eta_plus(window)

    @property
    def rate(self) -> Fraction:
        return self.events.rate * self.factor


@dataclass(frozen=True)
class Downsampled(DerivedEvents):
    """Every n-th event of another model."""

    prescaler: int

    def delta_min(self, count: int) -> Time:
        return self.events.delta_min((count - 1) * self.prescaler + 1) if count > 1 else 0

    def eta_plus(self, window: Time) -> int:
        return -(-self.events.eta_plus(window) // self.prescaler)

    @property
    def rate(self) -> Fraction:
        return self.events.rate / self.prescaler


@dataclass(frozen=True)
class Rescaled(DerivedEvents):
    """The same events in a unit of time that is smaller by a factor."""

    factor: int

    def delta_min(self, count: int) -> Time:
        return self.events.delta_min(count) * self.factor

    def eta_plus(self, window: Time) -> int:
        return self.events.eta_plus(-(-window // self.factor))

    @property
    def rate(self) -> Fraction:
        return self.events.rate / self.factor


def rescaled(events: EventModel, factor: int) -> EventModel:
    """Events in a unit of time that is smaller by a factor."""
    match events:
        case PeriodicEvents(period, jitter, distance):
            kinds = (ConditionalEvents, SporadicEvents, PeriodicEvents)
            kind = next(kind for kind in kinds if isinstance(events, kind))
            return kind(period * factor, jitter * factor, distance * factor)
    return Rescaled(events, factor)


@dataclass(frozen=True)
class Thinned(DerivedEvents):
    """Those events of another model for which a condition is true."""

    def delta_min(self, count: int) -> Time:
        return self.events.delta_min(count)

    def eta_plus(self, window: Time) -> int:
        return self.events.eta_plus(window)

    @property
    def can_be_suppressed(self) -> bool:
        return True


def thinned(events: EventModel) -> EventModel:
    """Events that occur only if a condition is true: none of them is certain, and there is no maximum time between two."""
    if isinstance(events, PeriodicEvents):
        return ConditionalEvents(events.period, events.jitter, events.min_interarrival)
    return Thinned(events)


@dataclass(frozen=True)
class Delayed(DerivedEvents):
    """Events delayed by a varying time.

    Attributes
    ----------
    variation : maximum minus minimum delay
    """

    variation: Time

    def delta_min(self, count: int) -> Time:
        return max(0, self.events.delta_min(count) - self.variation) if count > 1 else 0

    def eta_plus(self, window: Time) -> int:
        return self.events.eta_plus(window + self.variation) if window > 0 else 0


@dataclass(frozen=True)
class OutputEventModel(DerivedEvents):
    """The completions of the jobs of a task.

    Jobs of a task end at least their minimum execution time apart. The q-th job of a busy window ends no later than its entry in
    `completions`; the job `count` - 1 after it is activated no earlier than delta- and takes at least its minimum execution time.
    That bounds the distance of two completions (S. Schliecker, J. Rox, M. Ivers, R. Ernst, "Providing accurate event models for the
    analysis of heterogeneous multiprocessor systems", CODES+ISSS 2008).

    Attributes
    ----------
    completions : latest completions of the jobs of the longest busy window, from its start
    bcet : minimum execution time of a job, which is a lower bound of all response times
    """

    completions: tuple[Time, ...]
    bcet: Time

    def delta_min(self, count: int) -> Time:
        if count < 2:
            return 0
        if count not in self._distances:
            self._distances[count] = max((count - 1) * self.bcet, self._earliest(count) + self.bcet)
        return self._distances[count]

    def _earliest(self, count: int) -> Time:
        """Minimum time from the latest completion of a job to the earliest activation of the one `count` - 1 after it."""
        if isinstance(self.events, PeriodicEvents):
            return self._earliest_of_periodic(self.events, count - 1)
        ends = enumerate(self.completions, start=1)
        return min(self.events.delta_min(job + count - 1) - end for job, end in ends)

    def _earliest_of_periodic(self, events: PeriodicEvents, later: int) -> Time:
        """The same in one step: at first the minimum distance separates the events, then the period without the jitter."""
        dense, periodic = self._least_slacks
        close = min(max(events.close_together - later, 0), len(self.completions))
        found = [dense[close - 1] + later * events.min_interarrival] if close else []
        found += [periodic[close] + later * events.period - events.jitter] if close < len(self.completions) else []
        return min(found)

    @cached_property
    def _least_slacks(self) -> tuple[list[Time], list[Time]]:
        """Least times from completions to activations: at the minimum distance of the first jobs, in the period of the others."""
        assert isinstance(self.events, PeriodicEvents)
        distance, period = self.events.min_interarrival, self.events.period
        dense = [job * distance - end for job, end in enumerate(self.completions)]
        periodic = [job * period - end for job, end in enumerate(self.completions)]
        return list(accumulate(dense, min)), list(accumulate(reversed(periodic), min))[::-1]

    @property
    def variation(self) -> Time:
        """The longest minus the shortest time from an activation to its completion."""
        return self._wcrt - self.bcet

    @cached_property
    def _wcrt(self) -> Time:
        return max(end - self.events.delta_min(job) for job, end in enumerate(self.completions, start=1))

    @cached_property
    def _distances(self) -> dict[int, Time]:
        """Cached results; busy windows need the same ones many times."""
        return {}


def periodic_bound(events: EventModel) -> PeriodicEvents | None:
    """Periodic events with a jitter that are at least as dense; None if it is not known what they are delayed from.

    What varies between an event and one that follows from it adds to the jitter (K. Richter, "Compositional scheduling analysis using
    standard event models", 2005).
    """
    match events:
        case PeriodicEvents(period, jitter, _):
            return PeriodicEvents(period, jitter)
        case Delayed(source, variation):
            bound = periodic_bound(source)
        case OutputEventModel(source, variation=variation):
            bound = periodic_bound(source)
        case _:
            return None
    return None if bound is None else PeriodicEvents(bound.period, bound.jitter + variation)
