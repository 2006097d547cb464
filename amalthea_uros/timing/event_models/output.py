"""The event model of job completions, which activate other processes."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from amalthea_uros.timing.event_models.base import EventModel
from amalthea_uros.timing.event_models.periodic import Periodic
from amalthea_uros.units import Time


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
        if isinstance(self.events, Periodic) and not self.events.jitter:
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
