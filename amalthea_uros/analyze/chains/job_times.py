"""When the jobs of one step of a chain read and write.

What happens behind the steady_state_start part repeats with the cycle; so a track is extended as far as a chain reaches.
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
    """The jobs of a step, in order; as many as are released before `until`.

    Attributes
    ----------
    reads : when each job reads, or the earliest that it can
    writes : when what it writes can be read, or the latest that it can be
    cycle : time after which the last jobs repeat
    until : the end of the time that is covered
    preempts_reader : whether jobs come before those of the next step on the same core, so that those cannot read in between
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


def reach(tracks: Sequence[ReadWriteTimes]) -> Time:
    """More time than any chain through the tracks takes: at each step a job may be missed, and then another one."""
    return sum(2 * _longest_gap(track) + int((track.writes - track.reads).max()) for track in tracks)


def _longest_gap(track: ReadWriteTimes) -> Time:
    """The longest time between two reads that follow each other."""
    return int(np.diff(track.reads).max()) if len(track.reads) > 1 else track.cycle
