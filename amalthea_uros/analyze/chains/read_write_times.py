"""When the jobs of one task of a chain read and write.

In the steady state these times repeat in each cycle, so that they can be extended as far as a job chain reaches.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers


@dataclass(frozen=True, slots=True, kw_only=True)
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

    def scaled(self, factor: int) -> ReadWriteTimes:
        """The same in a unit of time that is smaller by a factor."""
        return replace(
            self,
            releases=self.releases * factor,
            reads=self.reads * factor,
            writes=self.writes * factor,
            cycle=self.cycle * factor,
            until=self.until * factor,
        )

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
    return sum(2 * _longest_gap(task) + _longest_delay(task) for task in chain)


def _longest_gap(task: ReadWriteTimes) -> Time:
    """The maximum time between two consecutive releases."""
    return int(np.diff(task.releases).max()) if len(task.releases) > 1 else task.cycle


def _longest_delay(task: ReadWriteTimes) -> Time:
    """The maximum time from the release of a job until it has read and written."""
    return int((np.maximum(task.reads, task.writes) - task.releases).max())
