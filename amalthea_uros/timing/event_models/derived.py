"""Event models derived from others: several sources, every n-th event, another unit of time, delayed events, completions of jobs."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from amalthea_uros.timing.event_models.base import NEVER, EventModel
from amalthea_uros.timing.event_models.periodic import ConditionalEvents, PeriodicEvents, SporadicEvents
from amalthea_uros.units import Time


@dataclass(frozen=True)
class AggregatedEventModel(EventModel):
    """Events of several independent sources."""

    sources: tuple[EventModel, ...]

    def eta_plus(self, window: Time) -> int:
        """See `EventModel`."""
        return sum(source.eta_plus(window) for source in self.sources)

    def delta_min(self, count: int) -> Time:
        """See `EventModel`."""
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
        """See `EventModel`."""
        return sum((source.rate for source in self.sources), Fraction(0))

    @property
    def can_be_suppressed(self) -> bool:
        """See `EventModel`."""
        return any(source.can_be_suppressed for source in self.sources)


def aggregated(sources: tuple[EventModel, ...]) -> EventModel:
    """The events of all sources; the same model for a single source."""
    return sources[0] if len(sources) == 1 else AggregatedEventModel(sources)


@dataclass(frozen=True)
class Multiplied(EventModel):
    """Several events for each event of another model, simultaneous in the worst case."""

    events: EventModel
    factor: int

    def delta_min(self, count: int) -> Time:
        """See `EventModel`."""
        return self.events.delta_min(-(-count // self.factor))

    @property
    def rate(self) -> Fraction:
        """See `EventModel`."""
        return self.events.rate * self.factor

    @property
    def can_be_suppressed(self) -> bool:
        """See `EventModel`."""
        return self.events.can_be_suppressed


@dataclass(frozen=True)
class Downsampled(EventModel):
    """Every n-th event of another model."""

    events: EventModel
    prescaler: int

    def delta_min(self, count: int) -> Time:
        """See `EventModel`."""
        return self.events.delta_min((count - 1) * self.prescaler + 1) if count > 1 else 0

    @property
    def rate(self) -> Fraction:
        """See `EventModel`."""
        return self.events.rate / self.prescaler

    @property
    def can_be_suppressed(self) -> bool:
        """See `EventModel`."""
        return self.events.can_be_suppressed


@dataclass(frozen=True)
class Rescaled(EventModel):
    """The same events in a unit of time that is smaller by a factor."""

    events: EventModel
    factor: int

    def delta_min(self, count: int) -> Time:
        """See `EventModel`."""
        return self.events.delta_min(count) * self.factor

    def eta_plus(self, window: Time) -> int:
        """See `EventModel`."""
        return self.events.eta_plus(-(-window // self.factor))

    @property
    def rate(self) -> Fraction:
        """See `EventModel`."""
        return self.events.rate / self.factor

    @property
    def can_be_suppressed(self) -> bool:
        """See `EventModel`."""
        return self.events.can_be_suppressed


def rescaled(events: EventModel, factor: int) -> EventModel:
    """Events in a unit of time that is smaller by a factor."""
    match events:
        case PeriodicEvents(period, jitter, distance):
            kinds = (ConditionalEvents, SporadicEvents, PeriodicEvents)
            kind = next(kind for kind in kinds if isinstance(events, kind))
            return kind(period * factor, jitter * factor, distance * factor)
    return Rescaled(events, factor)


@dataclass(frozen=True)
class Thinned(EventModel):
    """Those events of another model for which a condition is true."""

    events: EventModel

    def delta_min(self, count: int) -> Time:
        """See `EventModel`."""
        return self.events.delta_min(count)

    def eta_plus(self, window: Time) -> int:
        """See `EventModel`."""
        return self.events.eta_plus(window)

    @property
    def rate(self) -> Fraction:
        """See `EventModel`."""
        return self.events.rate

    @property
    def can_be_suppressed(self) -> bool:
        """See `EventModel`."""
        return True


def thinned(events: EventModel) -> EventModel:
    """Events that occur only if a condition is true: none of them is certain, and there is no maximum time between two."""
    if isinstance(events, PeriodicEvents):
        return ConditionalEvents(events.period, events.jitter, events.min_interarrival)
    return Thinned(events)


@dataclass(frozen=True)
class Delayed(EventModel):
    """Events delayed by a varying time.

    Attributes
    ----------
    variation : maximum minus minimum delay
    """

    events: EventModel
    variation: Time

    def delta_min(self, count: int) -> Time:
        """See `EventModel`."""
        return max(0, self.events.delta_min(count) - self.variation) if count > 1 else 0

    @property
    def rate(self) -> Fraction:
        """See `EventModel`."""
        return self.events.rate

    @property
    def can_be_suppressed(self) -> bool:
        """See `EventModel`."""
        return self.events.can_be_suppressed


@dataclass(frozen=True)
class OutputEventModel(EventModel):
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

    events: EventModel
    completions: tuple[Time, ...]
    bcet: Time

    def delta_min(self, count: int) -> Time:
        """See `EventModel`."""
        if count < 2:
            return 0
        if count not in self._distances:
            self._distances[count] = max((count - 1) * self.bcet, self._earliest(count) + self.bcet)
        return self._distances[count]

    def _earliest(self, count: int) -> Time:
        """Minimum time from the latest completion of a job to the earliest activation of the one `count` - 1 after it."""
        if isinstance(self.events, PeriodicEvents) and not self.events.jitter:
            # All distances are equal.
            return self.events.delta_min(count) - self._wcrt
        ends = enumerate(self.completions, start=1)
        return min(self.events.delta_min(job + count - 1) - end for job, end in ends)

    @cached_property
    def _wcrt(self) -> Time:
        return max(end - self.events.delta_min(job) for job, end in enumerate(self.completions, start=1))

    @cached_property
    def _distances(self) -> dict[int, Time]:
        """Cached results; busy windows need the same ones many times."""
        return {}

    @property
    def rate(self) -> Fraction:
        """See `EventModel`."""
        return self.events.rate

    @property
    def can_be_suppressed(self) -> bool:
        """See `EventModel`."""
        return self.events.can_be_suppressed
