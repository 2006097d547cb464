"""Multiframe demand: jobs have different demands if something is executed only every n-th time.

After A. K. Mok and D. Chen, "A multiframe model for real-time tasks", IEEE Transactions on Software Engineering 23(10), 1997. Frames
with different prescalers can fall on the same job, because their counters start together.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from amalthea_uros.units import Time


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

    worst: Time
    best: Time
    average: Fraction = Fraction(0)
    prescaler: int = 1
    offset: int = 0
    is_certain: bool = True
    jitter: int = 0
    least: Time | None = None

    @property
    def occurring(self) -> Time:
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
    def constant(cls, worst: Time, best: Time | None = None) -> MultiframeDemand:
        """The same demand for all jobs."""
        return cls((DemandFrame(worst=worst, best=worst if best is None else best, average=Fraction(worst)),))

    @property
    def is_certain(self) -> bool:
        """Whether it is known which jobs have which demand."""
        return all(frame.is_certain for frame in self.frames)

    def max_demand(self, count: int) -> Time:
        """Maximum demand of that many consecutive jobs."""
        return sum(frame.worst * min(count, -(-(count + frame.jitter) // frame.prescaler)) for frame in self.frames)

    def min_demand(self, count: int) -> Time:
        """Minimum demand of that many consecutive jobs."""
        return sum(frame.best * (count // frame.prescaler) for frame in self.frames)

    @property
    def worst(self) -> Time:
        """The worst-case execution time of a single job."""
        return self.max_demand(1)

    @property
    def least_worst(self) -> Time:
        """A demand that some job certainly can have: counters can keep frames of different jobs apart for ever."""
        always = sum(frame.occurring for frame in self.frames if frame.prescaler == 1)
        return always + max((frame.occurring for frame in self.frames if frame.prescaler > 1), default=0)

    @property
    def best(self) -> Time:
        """The best-case execution time of a single job."""
        return self.min_demand(1)

    def worst_of(self, job: int) -> Time:
        """Worst-case execution time of the n-th job, counted from 1."""
        return sum(frame.worst for frame in self.frames if not frame.is_certain or frame.falls_on(job))

    def best_of(self, job: int) -> Time:
        """Best-case execution time of the n-th job, counted from 1."""
        return sum(frame.best for frame in self.frames if frame.falls_on(job))

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
