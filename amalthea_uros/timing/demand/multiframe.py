"""Multiframe demand: jobs have different demands if something is executed only every n-th time.

After A. K. Mok and D. Chen, "A multiframe model for real-time tasks", IEEE Transactions on Software Engineering 23(10), 1997. Frames
with different prescalers can fall on the same job, because their counters start together.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import ceil, floor

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.perf.activities import Count
from amalthea_uros.timing.basics.time_base import Ticks
from amalthea_uros.timing.demand.means import exact_sum
from amalthea_uros.timing.jobs.executed import count_of

#: No demand.
NOTHING = Ticks(0)


@dataclass(frozen=True, slots=True, kw_only=True)
class DemandFrame:
    """Demand of every n-th job.

    Attributes
    ----------
    average : mean, for loads
    offset : number of the first such job, counted from 1; below 1 only its remainder modulo the prescaler counts
    is_certain : whether exactly these jobs have the demand; otherwise any job may have it or not, but at most every n-th one
    jitter : number of jobs by which the demand can be late, if it is not certain which jobs have it
    least : as far as it is certain that some job can have it, if modes may exclude the rest for ever; None: all of it
    """

    worst: Ticks
    best: Ticks
    average: Fraction = Fraction(0)
    prescaler: int = 1
    offset: int = 0
    is_certain: bool = True
    jitter: int = 0
    least: Ticks | None = None

    @property
    def occurring(self) -> Ticks:
        """The demand that some job certainly can have."""
        return self.worst if self.least is None else self.least

    @property
    def is_always(self) -> bool:
        """Whether each job has the demand."""
        return self.is_certain and self.prescaler == 1 and self.offset <= 1

    def falls_on(self, job: int) -> bool:
        """Whether a job, counted from 1, is one of those in which it is known to be executed."""
        return self.is_certain and job >= max(self.offset, 1) and (job - self.offset) % self.prescaler == 0


@dataclass(frozen=True, slots=True)
class MultiframeDemand:
    """The demand of the jobs of a process."""

    frames: tuple[DemandFrame, ...]

    @classmethod
    def constant(cls, worst: Ticks, best: Ticks | None = None) -> MultiframeDemand:
        """The same demand for all jobs."""
        return cls((DemandFrame(worst=worst, best=worst if best is None else best, average=Fraction(worst)),))

    @property
    def is_certain(self) -> bool:
        """Whether it is known which jobs have which demand."""
        return all(frame.is_certain for frame in self.frames)

    def max_demand(self, count: int) -> Ticks:
        """Maximum demand of that many consecutive jobs."""
        return Ticks(sum(frame.worst * min(count, -(-(count + frame.jitter) // frame.prescaler)) for frame in self.frames))

    def min_demand(self, count: int) -> Ticks:
        """Minimum demand of that many consecutive jobs."""
        return Ticks(sum(frame.best * (count // frame.prescaler) for frame in self.frames))

    @property
    def worst(self) -> Ticks:
        """The worst-case execution time of a single job."""
        return self.max_demand(1)

    @property
    def least_worst(self) -> Ticks:
        """A demand that some job certainly can have: counters can keep frames of different jobs apart for ever."""
        always = sum(frame.occurring for frame in self.frames if frame.prescaler == 1)
        return Ticks(always + max((frame.occurring for frame in self.frames if frame.prescaler > 1), default=0))

    @property
    def best(self) -> Ticks:
        """The best-case execution time of a single job."""
        return self.min_demand(1)

    def worst_of(self, job: int) -> Ticks:
        """Worst-case execution time of the n-th job, counted from 1."""
        return Ticks(sum(frame.worst for frame in self.frames if not frame.is_certain or frame.falls_on(job)))

    def best_of(self, job: int) -> Ticks:
        """Best-case execution time of the n-th job, counted from 1."""
        return Ticks(sum(frame.best for frame in self.frames if frame.falls_on(job)))

    @property
    def mean_worst(self) -> Fraction:
        """The worst-case execution time per job in the long run."""
        return sum((Fraction(frame.worst, frame.prescaler) for frame in self.frames), Fraction(0))

    @property
    def mean_occurring(self) -> Fraction:
        """The worst-case execution time per job in the long run, without what modes may exclude for ever."""
        return sum((Fraction(frame.occurring, frame.prescaler) for frame in self.frames), Fraction(0))

    @property
    def mean_best(self) -> Fraction:
        """The best-case execution time per job in the long run."""
        return sum((Fraction(frame.best, frame.prescaler) for frame in self.frames), Fraction(0))

    @property
    def mean(self) -> Fraction:
        """The mean execution time per job in the long run."""
        return sum((frame.average / frame.prescaler for frame in self.frames), Fraction(0))


def summed(frames: Sequence[DemandFrame]) -> tuple[DemandFrame, ...]:
    """The frames of the same jobs added up."""
    found: dict[tuple[int, int, bool, int], list[DemandFrame]] = {}
    for frame in frames:
        found.setdefault((frame.prescaler, frame.offset, frame.is_certain, frame.jitter), []).append(frame)
    return tuple(same[0] if len(same) == 1 else _sum(same) for same in found.values())


def _sum(same: Sequence[DemandFrame]) -> DemandFrame:
    return replace(
        same[0],
        worst=Ticks(sum(frame.worst for frame in same)),
        best=Ticks(sum(frame.best for frame in same)),
        average=exact_sum(frame.average for frame in same),
        # The demand that certainly occurs; None if all of it does.
        least=None if all(frame.least is None for frame in same) else Ticks(sum(frame.occurring for frame in same)),
    )


def scaled(frames: tuple[DemandFrame, ...], growth: Fraction) -> tuple[DemandFrame, ...]:
    """Frames with greater worst cases, so that they cover all smaller factors; with a factor below 1, best cases are smaller, too."""
    if growth == 1:
        return frames
    return tuple(
        replace(
            frame,
            worst=Ticks(ceil(frame.worst * growth)),
            best=Ticks(floor(frame.best * min(growth, Fraction(1)))),
            average=frame.average * growth,
            least=None if frame.least is None else Ticks(ceil(frame.least * growth)),
        )
        for frame in frames
    )


def at_most(access: DemandFrame) -> DemandFrame:
    """The demand of an access that may take no time."""
    return DemandFrame(worst=access.worst, best=NOTHING, average=access.average)


def any_time(frame: DemandFrame) -> DemandFrame:
    """A frame on unknown jobs: any job may execute it, and any job may not."""
    if frame.is_always or (frame.prescaler == 1 and not frame.is_certain):
        return frame
    return DemandFrame(
        worst=frame.worst, best=NOTHING, average=frame.average / frame.prescaler, is_certain=False, least=frame.least
    )


def repeated(frame: DemandFrame, times: Count | float) -> DemandFrame:
    """A frame that is executed several times."""
    minimum, average, maximum = count_of(times)
    return replace(
        frame,
        worst=Ticks(frame.worst * maximum),
        best=Ticks(frame.best * minimum),
        average=frame.average * average,
        least=None if frame.least is None else Ticks(frame.least * maximum),
    )


def one_of(
    alternatives: Sequence[Sequence[DemandFrame]], weights: Sequence[float], each_occurs: bool, *, is_chance: bool
) -> Sequence[DemandFrame]:
    """One frame that bounds all alternatives.

    Parameters
    ----------
    each_occurs : whether each job can take any of them
    is_chance : whether they are chosen at random, so that each one occurs some time; otherwise modes choose
    """
    plain = [[any_time(frame) for frame in frames] for frames in alternatives]
    worst = [sum(frame.worst for frame in frames) for frames in plain]
    best = [sum(frame.best for frame in frames) for frames in plain]
    average = [sum((frame.average for frame in frames), Fraction(0)) for frames in plain]
    total = sum(map(Fraction, weights))
    if not worst:
        return []
    if not total:
        weights, total = [1.0] * len(worst), Fraction(len(worst))
    weighted = sum((value * Fraction(weight) for value, weight in zip(average, weights, strict=True)), Fraction(0))
    is_certain = all(frame.is_certain for frames in plain for frame in frames)
    is_same = max(worst) == min(best)
    occurring = [sum(frame.occurring for frame in frames) for frames in plain]
    # Of alternatives that modes choose, some may never occur; one of them does.
    likely = [value for value, weight in zip(occurring, weights, strict=True) if weight]
    least = max(likely) if is_chance else min(occurring)
    return [
        DemandFrame(
            worst=Ticks(max(worst)),
            best=Ticks(min(best)),
            average=weighted / total,
            is_certain=is_certain and (each_occurs or is_same),
            least=None if least == max(worst) else Ticks(least),
        )
    ]
