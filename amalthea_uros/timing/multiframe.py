"""What jobs cost: not every job costs the same where something runs every n-th time only (multi-frame demand).

After A. K. Mok and D. Chen, "A multiframe model for real-time tasks", IEEE Transactions on Software Engineering 23(10), 1997. Parts
with different prescalers are taken to meet in one job, which is what counters that start together do.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """Something that a job executes, every n-th time.

    Attributes
    ----------
    average : mean, for loads
    offset : number of the first time, counted from 1; 0 stands for the prescaler itself
    """

    worst: Time
    best: Time
    average: Fraction = Fraction(0)
    prescaler: int = 1
    offset: int = 0

    def falls_on(self, job: int) -> bool:
        """Whether a job, counted from 1, executes it."""
        return job >= max(self.offset, 1) and (job - self.offset) % self.prescaler == 0


@dataclass(frozen=True, slots=True)
class Cost:
    """The demand of the jobs of a process."""

    parts: tuple[Part, ...]

    @classmethod
    def constant(cls, worst: Time, best: Time | None = None) -> Cost:
        """The same for all jobs."""
        return cls((Part(worst=worst, best=worst if best is None else best, average=Fraction(worst)),))

    def most(self, count: int) -> Time:
        """The most that so many consecutive jobs execute."""
        return sum(part.worst * -(-count // part.prescaler) for part in self.parts)

    def least(self, count: int) -> Time:
        """The least that so many consecutive jobs execute."""
        return sum(part.best * (count // part.prescaler) for part in self.parts)

    @property
    def worst(self) -> Time:
        """The worst-case execution time of a single job."""
        return self.most(1)

    @property
    def best(self) -> Time:
        """The best-case execution time of a single job."""
        return self.least(1)

    def worst_of(self, job: int) -> Time:
        """The most that a certain job executes, counted from 1."""
        return sum(part.worst for part in self.parts if part.falls_on(job))

    def best_of(self, job: int) -> Time:
        """The least that a certain job executes, counted from 1."""
        return sum(part.best for part in self.parts if part.falls_on(job))

    @property
    def mean_worst(self) -> Fraction:
        """The worst-case execution time per job in the long run."""
        return sum((Fraction(part.worst, part.prescaler) for part in self.parts), Fraction(0))

    @property
    def mean_best(self) -> Fraction:
        """The best-case execution time per job in the long run."""
        return sum((Fraction(part.best, part.prescaler) for part in self.parts), Fraction(0))

    @property
    def mean(self) -> Fraction:
        """The mean execution time per job in the long run."""
        return sum((part.average / part.prescaler for part in self.parts), Fraction(0))
