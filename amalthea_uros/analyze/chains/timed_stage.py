"""A stage of a chain with its read and write times."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import lcm

import numpy as np

from amalthea_uros.analyze.chains.bounds.chain_task import ChainTask
from amalthea_uros.analyze.chains.read_write_times import ReadWriteTimes
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.timing.jobs.counters import first_effect, is_always
from amalthea_uros.units import Time


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

        return replace(
            self, pessimistic=selected(self.pessimistic), optimistic=selected(self.optimistic), steady_state_start=begin
        )


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
