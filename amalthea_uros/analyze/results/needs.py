"""The execution time of a process on cores of each kind, where no single core with a known clock is stated."""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros._internal.records import dataclass
from amalthea_uros._internal.shown import Shown
from amalthea_uros.units import Frequency, Time


@dataclass(frozen=True, slots=True, kw_only=True)
class ExecutionOnCores(Shown):
    """The execution time of a process on cores of one type and clock, or its ticks if the clock is unknown.

    Attributes
    ----------
    core_type : None: any, or not stated
    cores : empty if the model has none
    best, worst : execution times, or numbers of ticks where the frequency is None
    mean : None if no mean is stated
    load : of one of these cores in the worst case, 1 is full; None if the clock or the activations are unknown
    least_frequency : the clock that the process fills alone in the worst case; None if the clock is known, or the activations are not
    reason : why the execution time is unknown, or what it does not contain
    """

    core_type: str | None
    cores: tuple[str, ...]
    frequency: Frequency | None
    best: Time | int | None = None
    mean: Fraction | None = None
    worst: Time | int | None = None
    load: Fraction | None = None
    least_frequency: Frequency | None = None
    reason: str = ""

    @property
    def in_ticks(self) -> bool:
        """Whether the execution times are numbers of ticks."""
        return self.frequency is None

    @property
    def bcet(self) -> Time | None:
        """The best-case execution time; None in ticks, as those below."""
        return None if self.in_ticks else self.best

    @property
    def acet(self) -> Fraction | None:
        """The mean execution time."""
        return None if self.in_ticks else self.mean

    @property
    def wcet(self) -> Time | None:
        """The worst-case execution time."""
        return None if self.in_ticks else self.worst

    @property
    def least_ticks(self) -> int | None:
        """The ticks of the shortest job; None if the clock is known, as those below."""
        return self.best if self.in_ticks else None

    @property
    def mean_ticks(self) -> Fraction | None:
        """The mean number of ticks."""
        return self.mean if self.in_ticks else None

    @property
    def most_ticks(self) -> int | None:
        """The ticks of the longest job."""
        return self.worst if self.in_ticks else None
