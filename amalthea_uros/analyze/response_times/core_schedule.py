"""The schedules of a core on which all releases are known, and what jobs have completed in them when.

The schedule over two hyperperiods after the last offset contains all situations (J. Leung and J. Whitehead, "On the complexity of
fixed-priority scheduling of periodic, real-time tasks", Performance Evaluation 2, 1982). With fixed releases and without blocking, a
job never ends later because another one executes for a shorter time, so that the schedule of all worst cases contains the worst-case
response times, and that of all best cases the best-case ones.

An access takes no time. If somebody else arrives at the very moment at which a job has executed what comes before the access, the job
may still access at once, or only when it has the core again, or, if the access is made elsewhere, at any moment in between.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import inf
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.response_times import schedule
from amalthea_uros.analyze.response_times.blocking import Blocking
from amalthea_uros.analyze.response_times.schedule import Jobs, PeriodicTask
from amalthea_uros.timing.activation.releases import known_releases
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.timing.scheduling.scheduled import ScheduledProcess, is_preemptive
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers
    from amalthea_uros.analyze.response_times.solution import Solution

METHOD = "schedule over the hyperperiod, fixed priorities, preemptive"
SOURCE = "Leung, Whitehead 1982"
#: The execution slices of schedules with at most so many jobs are always recorded: that is quicker than another schedule with them.
RECORDED_JOBS = 10_000


def periodic_tasks(core: str, solution: Solution) -> list[PeriodicTask]:
    """The tasks of a core, if all releases are known and nothing blocks, so that its schedule is known apart from execution times."""
    context, here = solution.context, solution.context.served(core, None)
    processes = [item for item in here if isinstance(item, ScheduledProcess)]
    if (
        len({item.rank for item in processes}) < len(here)
        or not all(solution.is_analysable(item.name) for item in processes)
        or not solution.is_closed(core)
        or context.has_loops_or_waits(core)
        or Blocking.of(processes, solution).is_possible
    ):
        return []
    time_base, found = context.demand_model.time_base(core), list[PeriodicTask]()
    for number, item in enumerate(processes):
        stimulus = known_releases(item.process, context.system)
        if stimulus is None or not is_preemptive(item) or item.name in context.decisions:
            return []
        found.append(
            PeriodicTask(
                name=item.name,
                period=stimulus.period * time_base,
                offset=stimulus.offset * time_base,
                demand=context.demands[item.name],
                priority=len(processes) - 1 - number,
            )
        )
    return found


@dataclass(frozen=True, slots=True)
class CoreSchedule:
    """The schedules of a core for all worst and all best cases, up to the end of the second hyperperiod in which everything repeats.

    The last of the cycles that are covered is the steady state.

    Attributes
    ----------
    has_slices : whether execution slices are recorded
    """

    tasks: Mapping[str, PeriodicTask]
    worst: Mapping[str, Jobs]
    best: Mapping[str, Jobs]
    steady_state_start: Time
    cycle: Time
    has_slices: bool

    @classmethod
    def of(cls, tasks: Sequence[PeriodicTask], with_slices: bool) -> CoreSchedule | None:
        """The schedules of some tasks; None if they are too long or the core is overloaded.

        Parameters
        ----------
        with_slices : whether execution slices are needed; those of short schedules are recorded anyway
        """
        cycle = schedule.hyperperiod(tasks)
        until = schedule.steady_state_start(tasks) + 2 * cycle
        if not schedule.fits(tasks, until):
            return None
        has_slices = with_slices or sum(until // task.period for task in tasks) <= RECORDED_JOBS
        recorded = [has_slices] * len(tasks)
        worst = schedule.schedule(tasks, until, MultiframeDemand.worst_of, recorded)
        is_constant = all(frame.is_certain and frame.worst == frame.best for task in tasks for frame in task.demand.frames)
        best = worst if is_constant else schedule.schedule(tasks, until, MultiframeDemand.best_of, recorded)
        return cls(
            tasks={task.name: task for task in tasks},
            worst={task.name: jobs for task, jobs in zip(tasks, worst, strict=True)},
            best={task.name: jobs for task, jobs in zip(tasks, best, strict=True)},
            steady_state_start=until - cycle,
            cycle=cycle,
            has_slices=has_slices,
        )

    @property
    def until(self) -> Time:
        """The end of the covered time; its last cycle repeats."""
        return self.steady_state_start + self.cycle

    @property
    def has_idle_time(self) -> bool:
        """Whether the core is idle in each cycle of the worst cases.

        That ends what came before: whatever it was, the worst cases lead to the same steady state.
        """
        return schedule.load(list(self.tasks.values())) < 1

    def busy_above(self, name: str) -> Busy:
        """When the core executes tasks of higher priority than one of them, in the worst case."""
        priority = self.tasks[name].priority
        above = [self.worst[task.name] for task in self.tasks.values() if task.priority > priority]
        return Busy.of(above, self.cycle, self.until)

    def response_times(self) -> dict[str, Response]:
        """The exact response times."""
        # Only tasks of at least the same priority have an effect.
        uncertain = max((task.priority for task in self.tasks.values() if not task.demand.is_certain), default=-inf)
        return {name: self._response(task, task.priority > uncertain) for name, task in self.tasks.items()}

    def _response(self, task: PeriodicTask, is_certain: bool) -> Response:
        worst, best = self.worst[task.name], self.best[task.name]
        responses = worst.ends - worst.releases
        at = int(responses.argmax())
        longest, own = int(responses[at]), task.demand.worst_of(at + 1)
        return Response(
            worst=longest,
            best=int((best.ends - best.releases).min()),
            method=METHOD,
            source=SOURCE,
            claim=Claim.EXACT if is_certain else Claim.BOUND,
            jobs=len(responses),
            window=longest,
            terms={"own": own, "interference": longest - own, "blocking": 0},
        )


def times_of_completion(jobs: Jobs, executed: Numbers) -> Numbers:
    """When each job has executed the given demand."""
    # The work that the task has completed at the end of each slice, and when a job has executed its demand.
    ends: Numbers = np.cumsum(jobs.execution_slices[:, 2] - jobs.execution_slices[:, 1])
    last_slices = np.searchsorted(jobs.execution_slices[:, 0], np.arange(len(executed)), side="right") - 1
    target = np.concatenate(([0], ends[last_slices[:-1]])) + executed
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
