"""When the jobs of the stages of a chain read and write.

In the steady state these times repeat in each cycle, so that they can be extended as far as a job chain reaches.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from math import lcm
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.analyze.chains.bounds import ChainTask
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.timing.jobs.counters import first_effect, is_always
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers


@dataclass(frozen=True, kw_only=True)
class ReadWriteTimes:
    """The jobs of a task that are released before `until`, in order.

    Attributes
    ----------
    reads : when each job reads, or a bound of that
    writes : when its output becomes visible, or a bound of that
    cycle : time after which the last jobs repeat
    until : the end of the time that is covered
    is_visible_at_once : whether what is written is seen by a read at the same instant
    preempts_reader : whether its jobs preempt those of the next task on the same core, so that these cannot read in between
    jobs_later : if the next task of the chain is a later part of the same process: 0 if a job already uses its own output, 1 if
        only the jobs after it do; None for another process, which uses what was written when it reads
    """

    releases: Numbers
    reads: Numbers
    writes: Numbers
    cycle: Time
    until: Time
    is_visible_at_once: bool = True
    preempts_reader: bool = False
    jobs_later: int | None = None

    @cached_property
    def reach(self) -> Time:
        """The part of a task in the time that a job chain covers; the same tasks are in many chains, which ask several times."""
        gap = int(np.diff(self.releases).max()) if len(self.releases) > 1 else self.cycle
        return 2 * gap + int((np.maximum(self.reads, self.writes) - self.releases).max())

    def extended(self, until: Time) -> ReadWriteTimes:
        """The same for a longer time."""
        rounds = -(-(until - self.until) // self.cycle)
        if rounds <= 0:
            return self
        last = int(np.searchsorted(self.releases, self.until - self.cycle))
        shifts = self.cycle * np.arange(1, rounds + 1, dtype=np.int64)[:, np.newaxis]

        def repeated(times: Numbers) -> Numbers:
            more: Numbers = np.concatenate((times, (times[last:] + shifts).ravel()))
            return more

        return replace(
            self,
            releases=repeated(self.releases),
            reads=repeated(self.reads),
            writes=repeated(self.writes),
            until=self.until + rounds * self.cycle,
        )

    def selected(self, jobs: Numbers, cycle: Time) -> ReadWriteTimes:
        """Only some of the jobs, which repeat after a cycle."""
        return replace(self, releases=self.releases[jobs], reads=self.reads[jobs], writes=self.writes[jobs], cycle=cycle)

    def has_times_of(self, other: ReadWriteTimes) -> bool:
        """Whether the jobs read and write at the same times as those of another one."""
        return all(
            mine is others or np.array_equal(mine, others)
            for mine, others in ((self.reads, other.reads), (self.writes, other.writes))
        )


def reach(chain: Sequence[ReadWriteTimes]) -> Time:
    """An upper bound of the time between the releases of the jobs of any job chain.

    At each task up to two periods of waiting, and the time from a release to a read or write. With bounds of these times a job can
    write before it reads, so that the time in between says nothing.
    """
    return sum(task.reach for task in chain)


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadWriteBounds:
    """Bounds of the times at which the jobs of a stage read and write.

    Attributes
    ----------
    pessimistic : earliest reads and latest writes
    optimistic : latest reads and earliest writes
    steady_state_start : time from which both repeat
    is_logical : whether they depend only on releases and periods
    """

    pessimistic: ReadWriteTimes
    optimistic: ReadWriteTimes
    steady_state_start: Time
    is_logical: bool = False

    @property
    def is_exact(self) -> bool:
        """Whether both are the actual times."""
        return self.pessimistic.has_times_of(self.optimistic) and self.pessimistic.jobs_later == self.optimistic.jobs_later

    def reading_at_release(self) -> ReadWriteBounds:
        """The times where jobs see nothing that is written after their releases, however late they read."""
        late = self.optimistic
        return self if self.is_exact else replace(self, optimistic=replace(late, reads=np.minimum(late.reads, late.releases)))

    def taking_part(self, counter: Counter, period: Time) -> ReadWriteBounds:
        """The times of only those jobs that a counter lets take part.

        Parameters
        ----------
        period : of the process
        """
        if is_always(counter):
            return self
        first, prescaler = first_effect(counter), counter.prescaler
        begin = self.steady_state_start + first * period

        def selected(times: ReadWriteTimes) -> ReadWriteTimes:
            cycle = lcm(times.cycle, period * prescaler)
            longer = times.extended(max(times.until, begin) + 2 * cycle)
            return longer.selected(np.arange(first - 1, len(longer.releases), prescaler), cycle)

        pessimistic = selected(self.pessimistic)
        optimistic = pessimistic if self.optimistic is self.pessimistic else selected(self.optimistic)
        return replace(self, pessimistic=pessimistic, optimistic=optimistic, steady_state_start=begin)


@dataclass(frozen=True, slots=True, kw_only=True)
class TimedStage:
    """A stage, together with those that it triggers, with its read and write times.

    Attributes
    ----------
    task : as the bounds see it
    read_write : None if they are unknown
    reason : why they are unknown
    why_irregular : why there is no maximum time between two jobs that take part; "" if there is one
    is_certain : whether it is known which jobs take part
    stimulus_wait : how long a job that takes part comes at most after one that begins the chain, but of which no trigger has an
        effect; None if there is no maximum
    responds_before_read : whether the event that ends the chain comes before the job reads
    """

    task: ChainTask
    read_write: ReadWriteBounds | None = None
    reason: str = ""
    why_irregular: str = ""
    is_certain: bool = True
    stimulus_wait: Time | None = 0
    responds_before_read: bool = False

    @property
    def is_exact(self) -> bool:
        """Whether the read and write times of each job are known exactly."""
        return self.read_write is not None and self.read_write.is_exact

    @property
    def is_visible_at_once(self) -> bool:
        """Whether what jobs write is certainly seen by a read at the same instant."""
        return self.read_write is None or self.read_write.pessimistic.is_visible_at_once

    @property
    def is_logical(self) -> bool:
        """Whether read and write times depend only on releases and periods."""
        return self.read_write is not None and self.read_write.is_logical
