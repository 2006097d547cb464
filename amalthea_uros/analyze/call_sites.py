"""The response time of one call in the jobs of a process, by the schedule of the core or by the response time of the process."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import lcm
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.analyze.response_times import metrics
from amalthea_uros.analyze.response_times.core_schedule import CoreSchedule, times_of_completion
from amalthea_uros.analyze.response_times.metrics import JobInterval
from amalthea_uros.analyze.response_times.schedule import demand_cycle, demand_table, demands_of_jobs
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.results.processes import Metric
from amalthea_uros.perf.activities import Activity, Call
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.timing.basics.time_base import max_time, min_time
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.jobs.counters import first_effect, is_always, takes_effect
from amalthea_uros.timing.jobs.positions import ActivityPosition
from amalthea_uros.timing.response import Response
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers


@dataclass(frozen=True, slots=True)
class CallSite:
    """A call in the jobs of a process.

    Attributes
    ----------
    terminates : whether jobs can end early
    """

    position: ActivityPosition
    terminates: bool
    solution: Solution

    @property
    def process(self) -> Process:
        """The process that executes the call."""
        return self.position.process

    @property
    def call(self) -> Call:
        """The activity at its position."""
        assert isinstance(self.position.activity, Call)
        return self.position.activity

    @property
    def counter(self) -> Counter | None:
        """In which jobs the call is executed; None if that is unknown."""
        return self.position.counter

    @property
    def is_simple(self) -> bool:
        """Whether the call is executed once in each job, or in those that a counter selects."""
        return self.is_once and self.counter is not None and self.counter.is_phase_known

    @property
    def is_once(self) -> bool:
        """Whether each job executes the call once and then what follows, or a counter, possibly an unknown one, prevents the call."""
        runnable = self.solution.context.system.runnables.get(self.call.runnable)
        return (
            self.position.is_certain
            and self.call.times is None
            and not self.terminates
            and runnable is not None
            and runnable.condition is None
        )

    @property
    def net(self) -> Metric:
        """The net execution time of one call."""
        demand = self._demand([replace(self.call, counter=None, times=None)])
        time_base = self.solution.context.time_base(self.process.name)
        best, worst = min_time(demand.best, time_base), max_time(demand.worst, time_base)
        is_constant = demand.best == demand.worst
        return Metric(min=best, max=worst, mean=demand.mean / time_base, attained=(best, worst) if is_constant else None)

    def by_schedule(self, found: CoreSchedule) -> Metric:
        """The response time, by the schedule of the core."""
        name = self.process.name
        jobs, time_base = (found.best[name], found.worst[name]), self.solution.context.time_base(name)
        releases = metrics.both(each.releases for each in jobs)
        repeating = found.cycle // found.tasks[name].period
        if not self.is_simple:
            # Somewhere between the start and the end of the job.
            earliest = jobs[0].begins + self._demand([self.call]).best
            anywhere = JobInterval(releases, (earliest, jobs[1].ends)).metric(repeating, time_base, is_attained=False)
            return replace(anywhere, mean=None)
        count, counter = len(releases[0]), self.counter
        executed, others = self._until(), self._besides_activities(count)
        ends = (
            times_of_completion(jobs[0], demands_of_jobs(executed, count, MultiframeDemand.best_of)),
            times_of_completion(jobs[1], demands_of_jobs(executed, count, MultiframeDemand.worst_of) + others),
        )
        calling, is_attained = np.ones(count, dtype=bool), not others.any()
        if counter is not None and not is_always(counter):
            first = first_effect(counter)
            if repeating % counter.prescaler or first > count - repeating:
                # The call costs nothing, so that the schedule repeats before its counter does.
                is_attained = False
            else:
                calling = np.array([takes_effect(counter, number) for number in range(1, count + 1)])
        selected = JobInterval(metrics.both(each[calling] for each in releases), metrics.both(each[calling] for each in ends))
        metric = selected.metric(int(calling[-repeating:].sum()), time_base, is_attained, found.has_idle_time)
        return metric if is_attained else replace(metric, mean=None)

    def by_response(self, response: Response) -> Metric:
        """Bounds of the response time, by that of the process."""
        time_base = self.solution.context.time_base(self.process.name)
        before, after = Time(0), Time(0)
        if self.is_simple and self.counter is not None:
            until = self._until()
            # Those in which counters have not started, and one of each combination after that.
            count = len(demand_table(until, MultiframeDemand.best_of)) + first_effect(self.counter)
            count += lcm(demand_cycle(until), self.counter.prescaler)
            before = min(until.best_of(job) for job in range(1, count + 1) if takes_effect(self.counter, job))
        elif self.is_once:
            # Whatever the call follows, it takes its own time.
            before = self._demand([replace(self.call, counter=None)]).best
        if self.is_once:
            following = [activity for activities, index in self.position.outer for activity in activities[index + 1 :]]
            after = min_time(self._demand(following).best, time_base)
        return Metric(
            min=before // time_base,
            max=None if response.worst is None else response.worst - after,
        )

    def _until(self) -> MultiframeDemand:
        """What jobs execute until the end of the call."""
        context = self.solution.context
        return context.demand_model.of_position(self.position, context.scheduled[self.process.name].core, including=True)

    def _demand(self, activities: Sequence[Activity]) -> MultiframeDemand:
        context = self.solution.context
        return context.demand_model.of_activities(self.process, activities, context.scheduled[self.process.name].core)

    def _besides_activities(self, count: int) -> Numbers:
        """What each job executes besides the activities of its process, such as copies of labels: possibly before the call."""
        everything, activities = self.solution.context.demands[self.process.name], self._demand(self.process.activities)
        return demands_of_jobs(everything, count, MultiframeDemand.worst_of) - demands_of_jobs(
            activities, count, MultiframeDemand.worst_of
        )
