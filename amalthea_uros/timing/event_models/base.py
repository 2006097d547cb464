"""Event models: how many arrivals there can be in a window (eta+), and how close they can be (delta-).

After K. Richter, "Compositional Scheduling Analysis Using Standard Event Models", TU Braunschweig, 2005. A window is half open: an
arrival at its end does not count.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from amalthea_uros.units import Time

#: Longer than anything: the distance of arrivals that never come.
NEVER: Time = 2**62


class Arrivals:
    """Arrivals of which the density is bounded; subclasses give `span` and `rate`."""

    def span(self, count: int) -> Time:
        """Delta-: the least time from the first to the last of so many consecutive arrivals."""
        raise NotImplementedError

    @property
    def rate(self) -> Fraction:
        """The most arrivals per time in the long run."""
        raise NotImplementedError

    @property
    def gap(self) -> Time | None:
        """The longest time from one arrival to the next; None if that is not bounded, or not known."""
        return None

    def most(self, window: Time) -> int:
        """Eta+: the most arrivals in a window of that length."""
        if window <= 0:
            return 0
        above = 2
        while self.span(above) < window:
            above *= 2
        below = above // 2
        # span(below) < window <= span(above), where a single arrival always fits.
        while above - below > 1:
            middle = (below + above) // 2
            below, above = (middle, above) if self.span(middle) < window else (below, middle)
        return below


@dataclass(frozen=True)
class Periodic(Arrivals):
    """Periodic with jitter and least distance.

    Attributes
    ----------
    sporadic : whether arrivals may also stay away; the period is then the least time between two of them
    longest : the longest time between two of them, if they are sporadic and that is known
    """

    period: Time
    jitter: Time = 0
    distance: Time = 0
    sporadic: bool = False
    longest: Time | None = None

    def span(self, count: int) -> Time:
        """See `Arrivals`."""
        return max(0, (count - 1) * self.distance, (count - 1) * self.period - self.jitter) if count > 1 else 0

    def most(self, window: Time) -> int:
        """See `Arrivals`."""
        if window <= 0:
            return 0
        count = -(-(window + self.jitter) // self.period)
        return min(count, -(-window // self.distance)) if self.distance else count

    @property
    def rate(self) -> Fraction:
        """See `Arrivals`."""
        return Fraction(1, self.period)

    @property
    def gap(self) -> Time | None:
        """See `Arrivals`."""
        return self.longest if self.sporadic else self.period + self.jitter


@dataclass(frozen=True)
class Pattern(Arrivals):
    """A list of arrivals that repeats: bursts and synthetic stimuli.

    Attributes
    ----------
    times : rising, within the period
    """

    period: Time
    times: tuple[Time, ...]

    def span(self, count: int) -> Time:
        """See `Arrivals`."""
        if count < 2:
            return 0
        rounds, steps = divmod(count - 1, len(self.times))
        return rounds * self.period + self._least[steps]

    def most(self, window: Time) -> int:
        """See `Arrivals`."""
        if window <= 0:
            return 0
        rounds, rest = divmod(window - 1, self.period)
        return rounds * len(self.times) + bisect_right(self._least, rest)

    @cached_property
    def _least(self) -> list[Time]:
        """The least time that so many steps take, for less than a round."""
        twice = (*self.times, *(time + self.period for time in self.times))
        length = len(self.times)
        return [min(twice[i + steps] - twice[i] for i in range(length)) for steps in range(length)]

    @property
    def rate(self) -> Fraction:
        """See `Arrivals`."""
        return Fraction(len(self.times), self.period)

    @property
    def gap(self) -> Time:
        """See `Arrivals`."""
        ends = (*self.times[1:], self.times[0] + self.period)
        return max(end - start for start, end in zip(self.times, ends, strict=True))


@dataclass(frozen=True)
class Curve(Arrivals):
    """Arrivals of which only least distances are given, for some counts.

    Attributes
    ----------
    distances : (count, least time that so many consecutive arrivals span)
    """

    distances: tuple[tuple[int, Time], ...]

    @cached_property
    def _best(self) -> tuple[int, Time]:
        """The entry that is densest in the long run, as (steps, time)."""
        return max(((count - 1, time) for count, time in self.distances), key=lambda entry: Fraction(entry[1], entry[0]))

    def span(self, count: int) -> Time:
        """See `Arrivals`; distances add up over consecutive groups of arrivals."""
        steps_at_once, time = self._best
        # Beyond the first rounds the densest entry is repeated; the rest is put together in the best way.
        rounds, rest = divmod(max(0, count - 1), steps_at_once)
        return rounds * time + self._put_together[rest]

    @cached_property
    def _put_together(self) -> list[Time]:
        """The least time of so many steps, for fewer steps than the densest entry has."""
        best = [0]
        for reached in range(1, self._best[0]):
            usable = [(count - 1, time) for count, time in self.distances if count - 1 <= reached]
            best.append(max((best[reached - step] + time for step, time in usable), default=best[reached - 1]))
        return best

    @property
    def rate(self) -> Fraction:
        """See `Arrivals`."""
        steps, time = self._best
        return Fraction(steps, time) if time else Fraction(NEVER)


@dataclass(frozen=True)
class Once(Arrivals):
    """A single arrival."""

    def span(self, count: int) -> Time:
        """See `Arrivals`."""
        return 0 if count < 2 else NEVER

    @property
    def rate(self) -> Fraction:
        """See `Arrivals`."""
        return Fraction(0)


@dataclass(frozen=True)
class Every(Arrivals):
    """Only every n-th of other arrivals."""

    arrivals: Arrivals
    prescaler: int

    def span(self, count: int) -> Time:
        """See `Arrivals`."""
        return self.arrivals.span((count - 1) * self.prescaler + 1) if count > 1 else 0

    @property
    def rate(self) -> Fraction:
        """See `Arrivals`."""
        return self.arrivals.rate / self.prescaler


@dataclass(frozen=True)
class Repeated(Arrivals):
    """Several arrivals for each of others, at the same moment in the worst case."""

    arrivals: Arrivals
    times: int

    def span(self, count: int) -> Time:
        """See `Arrivals`."""
        return self.arrivals.span(-(-count // self.times))

    @property
    def rate(self) -> Fraction:
        """See `Arrivals`."""
        return self.arrivals.rate * self.times


@dataclass(frozen=True)
class Delayed(Arrivals):
    """Arrivals behind something that takes a varying time.

    Attributes
    ----------
    variation : greatest minus least delay
    """

    arrivals: Arrivals
    variation: Time

    def span(self, count: int) -> Time:
        """See `Arrivals`."""
        return max(0, self.arrivals.span(count) - self.variation) if count > 1 else 0

    @property
    def rate(self) -> Fraction:
        """See `Arrivals`."""
        return self.arrivals.rate


@dataclass(frozen=True)
class Behind(Arrivals):
    """The ends of the jobs of a task.

    Jobs of one task end at least their least cost apart. The q-th job of a busy window ends at its completion at the latest, and the
    one `count` - 1 later arrives at its span at the earliest and takes its least cost: so close two ends can be (S. Schliecker,
    J. Rox, M. Ivers, R. Ernst, "Providing accurate event models for the analysis of heterogeneous multiprocessor systems", CODES+ISSS
    2008).

    Attributes
    ----------
    completions : when the jobs of the longest busy window end at the latest, from its start
    least : least cost of a job, which no response time is below, also not that of the first job of a system
    """

    arrivals: Arrivals
    completions: tuple[Time, ...]
    least: Time

    def span(self, count: int) -> Time:
        """See `Arrivals`."""
        if count < 2:
            return 0
        if count not in self._spans:
            self._spans[count] = max((count - 1) * self.least, self._earliest(count) + self.least)
        return self._spans[count]

    def _earliest(self, count: int) -> Time:
        """The least time from the latest end of a job to the earliest arrival of the one that is so many behind."""
        if isinstance(self.arrivals, Periodic) and not self.arrivals.jitter:
            # All distances are the same.
            return self.arrivals.span(count) - self._latest
        ends = enumerate(self.completions, start=1)
        return min(self.arrivals.span(job + count - 1) - end for job, end in ends)

    @cached_property
    def _latest(self) -> Time:
        """The longest response time."""
        return max(end - self.arrivals.span(job) for job, end in enumerate(self.completions, start=1))

    @cached_property
    def _spans(self) -> dict[int, Time]:
        """What has been found; windows ask for the same again and again."""
        return {}

    @property
    def rate(self) -> Fraction:
        """See `Arrivals`."""
        return self.arrivals.rate


@dataclass(frozen=True)
class Finer(Arrivals):
    """The same arrivals in a unit of time that is smaller by a factor."""

    arrivals: Arrivals
    factor: int

    def span(self, count: int) -> Time:
        """See `Arrivals`."""
        return self.arrivals.span(count) * self.factor

    def most(self, window: Time) -> int:
        """See `Arrivals`."""
        return self.arrivals.most(-(-window // self.factor))

    @property
    def rate(self) -> Fraction:
        """See `Arrivals`."""
        return self.arrivals.rate / self.factor


def finer(arrivals: Arrivals, factor: int) -> Arrivals:
    """Arrivals in a unit of time that is smaller by a factor."""
    match arrivals:
        case Periodic(period, jitter, distance, sporadic):
            return Periodic(period * factor, jitter * factor, distance * factor, sporadic)
    return Finer(arrivals, factor)


@dataclass(frozen=True)
class Together(Arrivals):
    """Arrivals from several sources that do not know of each other."""

    sources: tuple[Arrivals, ...]

    def most(self, window: Time) -> int:
        """See `Arrivals`."""
        return sum(source.most(window) for source in self.sources)

    def span(self, count: int) -> Time:
        """See `Arrivals`."""
        if count not in self._spans:
            self._spans[count] = self._span(count)
        return self._spans[count]

    @cached_property
    def _spans(self) -> dict[int, Time]:
        """What has been found; windows ask for the same again and again."""
        return {}

    def _span(self, count: int) -> Time:
        if count <= 1 or self.most(1) >= count:
            return 0
        above = 1
        while self.most(above + 1) < count:
            above *= 2
            if above >= NEVER:
                return NEVER
        below = above // 2
        while above - below > 1:
            middle = (below + above) // 2
            below, above = (below, middle) if self.most(middle + 1) >= count else (middle, above)
        return above

    @property
    def rate(self) -> Fraction:
        """See `Arrivals`."""
        return sum((source.rate for source in self.sources), Fraction(0))
