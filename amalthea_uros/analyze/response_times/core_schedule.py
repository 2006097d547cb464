"""The schedules of the cores of a system, each computed once, and what jobs have completed in them when.

An access takes no time. If somebody else arrives at the very moment at which a job has executed what comes before the access, the job
may still access at once, or only when it has the core again, or, if the access is made elsewhere, at any moment in between.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.analyze.response_times import schedule
from amalthea_uros.analyze.response_times.core import periodic_tasks
from amalthea_uros.analyze.response_times.schedule import Jobs, PeriodicTask
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers


@dataclass(frozen=True, slots=True)
class CoreSchedule:
    """The schedules of a core for all worst and all best cases.

    The last of the cycles that are covered is the steady state.

    Attributes
    ----------
    has_idle_time : whether the core is idle in each cycle of the worst cases, which then ends what came before: whatever it was, the
        worst cases lead to the same steady state
    """

    tasks: Mapping[str, PeriodicTask]
    worst: Mapping[str, Jobs]
    best: Mapping[str, Jobs]
    steady_state_start: Time
    cycle: Time
    has_idle_time: bool

    @property
    def until(self) -> Time:
        """The end of the covered time; its last cycle repeats."""
        return self.steady_state_start + self.cycle

    def busy_above(self, name: str) -> Busy:
        """When the core executes tasks of higher priority than one of them, in the worst case."""
        priority = self.tasks[name].priority
        above = [self.worst[task.name] for task in self.tasks.values() if task.priority > priority]
        return Busy.of(above, self.cycle, self.until)


@dataclass(slots=True)
class CoreSchedules:
    """The schedules of all cores."""

    solution: Solution
    _found: dict[tuple[str, bool], CoreSchedule | None] = field(default_factory=dict)

    def of(self, core: str, with_slices: bool) -> CoreSchedule | None:
        """The schedule of a core; None if it is unknown or too long.

        Parameters
        ----------
        with_slices : whether the execution slices of jobs are needed
        """
        # One with slices serves for both.
        key = (core, with_slices or (core, True) in self._found)
        if key not in self._found:
            self._found[key] = self._new(core, with_slices)
        return self._found[key]

    def _new(self, core: str, with_slices: bool) -> CoreSchedule | None:
        tasks = periodic_tasks(core, self.solution)
        if not tasks:
            return None
        found = self.solution.schedule(core, tasks, with_slices)
        if found is None:
            return None
        cycle, names = schedule.hyperperiod(tasks), [task.name for task in tasks]
        return CoreSchedule(
            tasks=dict(zip(names, tasks, strict=True)),
            worst=dict(zip(names, found.worst, strict=True)),
            best=dict(zip(names, found.best, strict=True)),
            steady_state_start=schedule.steady_state_start(tasks) + cycle,
            cycle=cycle,
            has_idle_time=sum((task.demand.mean_worst / task.period for task in tasks), Fraction(0)) < 1,
        )


def times_of_completion(jobs: Jobs, executed: Numbers) -> Numbers:
    """When each job has executed the given demand."""
    ends, target = _targets(jobs, executed)
    at = np.searchsorted(ends, target, side="left")
    found: Numbers = jobs.execution_slices[at, 2] - (ends[at] - target)
    return np.where(executed > 0, found, jobs.begins)


@dataclass(frozen=True, slots=True)
class Busy:
    """When a core executes some tasks, in the steady state again and again.

    Attributes
    ----------
    begins, ends : of the times without interruption, in order
    cycle : time after which they repeat
    until : the end of the time that is covered
    """

    begins: Numbers
    ends: Numbers
    cycle: Time
    until: Time

    @classmethod
    def of(cls, tasks: Sequence[Jobs], cycle: Time, until: Time) -> Busy:
        """The times at which a core executes one of some tasks whose execution slices are known."""
        slices = np.concatenate([np.zeros((0, 3), dtype=np.int64), *(jobs.execution_slices for jobs in tasks)])[:, 1:]
        slices = slices[slices[:, 0] < slices[:, 1]]
        slices = slices[np.argsort(slices[:, 0])]
        is_first = np.ones(len(slices), dtype=bool)
        is_first[1:] = slices[1:, 0] > slices[:-1, 1]
        is_last = np.ones(len(slices), dtype=bool)
        is_last[:-1] = is_first[1:]
        return cls(slices[is_first, 0], slices[is_last, 1], cycle, until)

    def resumption(self, times: Numbers) -> Numbers:
        """From each time on, when the core is first free of these tasks; they have it if one of them arrives at that time."""
        if not len(self.begins):
            return times
        found = times
        while True:
            # What is released after the covered time is found one or several cycles before.
            shift = np.maximum(0, (found - self.until) // self.cycle + 1) * self.cycle
            at = np.searchsorted(self.begins, found - shift, side="right") - 1
            later: Numbers = np.where(at >= 0, np.maximum(found, self.ends[at] + shift), found)
            if np.array_equal(later, found):
                return found
            found = later


def _targets(jobs: Jobs, executed: Numbers) -> tuple[Numbers, Numbers]:
    """The work that the task has completed at the end of each slice, and when each job has executed the given demand."""
    ends: Numbers = np.cumsum(jobs.execution_slices[:, 2] - jobs.execution_slices[:, 1])
    last_slices = np.searchsorted(jobs.execution_slices[:, 0], np.arange(len(executed)), side="right") - 1
    done = np.concatenate(([0], ends[last_slices[:-1]]))
    return ends, done + executed
