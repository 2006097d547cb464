"""When the jobs of one task of a chain read and write.

In the steady state these times repeat in each cycle, so that they can be extended as far as a job chain reaches.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
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
    reads : when each job reads, or a lower bound of that
    writes : when its output becomes visible, or an upper bound of that
    cycle : time after which the last jobs repeat
    until : the end of the time that is covered
    preempts_reader : whether its jobs preempt those of the next task on the same core, so that these cannot read in between
    """

    releases: Numbers
    reads: Numbers
    writes: Numbers
    cycle: Time
    until: Time
    preempts_reader: bool = False

    def scaled(self, factor: int) -> ReadWriteTimes:
        """The same in a unit of time that is smaller by a factor."""
        return ReadWriteTimes(
            releases=self.releases * factor,
            reads=self.reads * factor,
            writes=self.writes * factor,
            cycle=self.cycle * factor,
            until=self.until * factor,
            preempts_reader=self.preempts_reader,
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

        return ReadWriteTimes(
            releases=repeated(self.releases),
            reads=repeated(self.reads),
            writes=repeated(self.writes),
            cycle=self.cycle,
            until=self.until + rounds * self.cycle,
            preempts_reader=self.preempts_reader,
        )


def reach(chain: Sequence[ReadWriteTimes]) -> Time:
    """An upper bound of the length of any job chain: at each task up to two periods of waiting, and the time from read to write."""
    return sum(2 * _longest_gap(task) + int((task.writes - task.reads).max()) for task in chain)


def _longest_gap(task: ReadWriteTimes) -> Time:
    """The maximum time between two consecutive reads."""
    return int(np.diff(task.reads).max()) if len(task.reads) > 1 else task.cycle
