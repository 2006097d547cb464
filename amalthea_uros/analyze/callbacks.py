"""The response times of callbacks: from the activation of a job to the end of the call, in the jobs that call it.

An executor calls its callbacks one after the other, so that most of them end before its job does. If the schedule of the core is known,
it shows when the job has executed everything up to the end of the call. Otherwise the response time of the process is a bound, less
what the job still executes at least after the call.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import lcm

import numpy as np

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.analyze.response_times import metrics
from amalthea_uros.analyze.response_times.core_schedule import CoreSchedule, times_of_completion
from amalthea_uros.analyze.response_times.schedule import demand_cycle, demand_lead, demands_of_jobs
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.results.processes import CallbackResult, Metric
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.results import ExecutorResult, HandleResult
from amalthea_uros.perf.activities import Activity, Call, ServerCall, Terminate
from amalthea_uros.perf.constraints import Bound, TimeLimit, TimeMetric
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.timing.basics.time_base import max_time, min_time
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.jobs.counters import first_effect, is_always, min_distance, takes_effect
from amalthea_uros.timing.jobs.positions import ActivityPosition
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.units import Time

_METHOD = "response time of the process, less the minimum demand after the call"
#: With more jobs until their demands repeat, what is executed before a call may be nothing.
_MOST_JOBS = 100_000


@dataclass(slots=True)
class CallbackEvaluator:
    """Finds the response times of callbacks and of other runnables with requirements."""

    solution: Solution
    executors: Sequence[ExecutorResult] = ()
    _limits: dict[str, Time | None] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for requirement in self.context.system.constraints.requirements:
            if requirement.runnable is None:
                continue
            limit = self._limits.setdefault(requirement.runnable, None)
            match requirement.limit:
                case TimeLimit(metric=TimeMetric.RESPONSE_TIME, bound=Bound.UPPER, value=value):
                    self._limits[requirement.runnable] = value if limit is None else min(value, limit)

    @property
    def context(self) -> TimingContext:
        """The timing context of the system."""
        return self.solution.context

    def all(self) -> Iterator[CallbackResult]:
        """The results of all callbacks, by process in the order of their calls."""
        wanted = {runnable.name for runnable in self.context.system.software.runnables if runnable.callback} | set(self._limits)
        if not wanted:
            return
        looping = {executor.task: executor for executor in self.executors}
        for process in self.context.system.processes.values():
            if process.name in looping:
                yield from callback_results(looping[process.name], self._limits)
                continue
            try:
                positions = self.context.dataflow.events.positions(process.name)
            except UnknownError as error:
                # It can call any of them.
                yield from (_unknown(name, process, str(error)) for name in sorted(wanted))
                continue
            calls: dict[str, list[ActivityPosition]] = {}
            for position in positions:
                match position.activity:
                    case Call(runnable=name) if name in wanted:
                        calls.setdefault(name, []).append(position)
                    case ServerCall(runnable=name, result=result):
                        served = wanted & {name, result}
                        yield from (_unknown(each, process, "server calls execute it") for each in sorted(served))
            terminates = any(isinstance(position.activity, Terminate) for position in positions)
            for name, found in calls.items():
                yield self._result(name, process, [CallSite(position, terminates, self.solution) for position in found])

    def _result(self, name: str, process: Process, sites: Sequence[CallSite]) -> CallbackResult:
        response = self.solution.responses.get(process.name)
        if response is None:
            reason = self.solution.reasons.get(process.name, "it was not analysed")
            return _unknown(
                name, process, f"the response time of {process.name!r} is unknown: {reason}", self._deadline(name, sites)
            )
        is_exact = response.claim is Claim.EXACT and not self.solution.depends_on_losses(process.name)
        core = self.context.scheduled[process.name].core
        known = self.solution.schedule(core, with_slices=True) if is_exact else None
        found = [site.by_schedule(known) if known is not None else site.by_response(response) for site in sites]
        combined = metrics.merged([{JobMetric.RESPONSE_TIME: metric} for metric in found])[JobMetric.RESPONSE_TIME]
        if len(found) > 1:
            # Not every call site need be reached equally often.
            combined = replace(combined, mean=None)
        return CallbackResult(
            name=name,
            process=process.name,
            response=Response(
                worst=combined.max,
                best=combined.min or 0,
                method=_METHOD if known is None else response.method,
                source=response.source,
                claim=combined.claim,
                reason=response.reason,
            ),
            deadline=self._deadline(name, sites),
            reason=response.reason,
            metrics={
                JobMetric.RESPONSE_TIME: combined,
                JobMetric.NET_EXECUTION_TIME: metrics.merged([{JobMetric.NET_EXECUTION_TIME: site.net} for site in sites])[
                    JobMetric.NET_EXECUTION_TIME
                ],
            },
        )

    def _deadline(self, name: str, sites: Sequence[CallSite]) -> Time | None:
        """The limit of the response time, or else the minimum time from one call to the next."""
        limit = self._limits.get(name)
        if limit is not None or len(sites) > 1 or not sites[0].is_simple:
            return limit
        events = self.solution.event_models.get(sites[0].process.name)
        counter = sites[0].counter
        return None if events is None else events.delta_min(1 + (min_distance(counter) if counter is not None else 1))


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
            anywhere = metrics.JobInterval(releases, (earliest, jobs[1].ends)).metric(repeating, time_base, is_attained=False)
            return replace(anywhere, mean=None)
        count, counter = len(releases[0]), self.counter
        executed, worst = self._until(), MultiframeDemand.worst_of
        # What belongs to no activity, such as copies of labels, can come before the call.
        activities = demands_of_jobs(self._demand(self.process.activities), count, worst)
        others = demands_of_jobs(self.solution.context.demands[name], count, worst) - activities
        ends = (
            times_of_completion(jobs[0], demands_of_jobs(executed, count, MultiframeDemand.best_of)),
            times_of_completion(jobs[1], demands_of_jobs(executed, count, worst) + others),
        )
        calling, is_attained = np.ones(count, dtype=bool), not others.any()
        if counter is not None and not is_always(counter):
            first = first_effect(counter)
            if repeating % counter.prescaler or first > count - repeating:
                # The call costs nothing, so that the schedule repeats before its counter does.
                is_attained = False
            else:
                calling = np.array([takes_effect(counter, number) for number in range(1, count + 1)])
        selected = metrics.JobInterval(
            metrics.both(each[calling] for each in releases), metrics.both(each[calling] for each in ends)
        )
        metric = selected.metric(int(calling[-repeating:].sum()), time_base, is_attained, found.has_idle_time)
        return metric if is_attained else replace(metric, mean=None)

    def by_response(self, response: Response) -> Metric:
        """Bounds of the response time, by that of the process."""
        time_base = self.solution.context.time_base(self.process.name)
        before, after = Time(0), Time(0)
        if self.is_simple and self.counter is not None:
            until = self._until()
            # Those in which counters have not started, and one of each combination after that.
            count = demand_lead(until) + demand_cycle(until) + first_effect(self.counter)
            count += lcm(demand_cycle(until), self.counter.prescaler)
            if count <= _MOST_JOBS:
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
        return context.execution_model(self.process.name).of_position(
            self.position, context.scheduled[self.process.name].core, including=True
        )

    def _demand(self, activities: Sequence[Activity]) -> MultiframeDemand:
        context = self.solution.context
        name = self.process.name
        return context.execution_model(name).of_activities(self.process, activities, context.scheduled[name].core)


def _unknown(name: str, process: Process, reason: str, deadline: Time | None = None) -> CallbackResult:
    return CallbackResult(name=name, process=process.name, response=None, deadline=deadline, reason=reason)


def callback_results(executor: ExecutorResult, limits: Mapping[str, Time | None]) -> Iterator[CallbackResult]:
    """The callbacks of an executor, in its order; several handles can have the same one.

    Parameters
    ----------
    limits : of response times, by the names of runnables
    """
    by_runnable: dict[str, list[HandleResult]] = {}
    for handle in executor.handles:
        by_runnable.setdefault(handle.runnable, []).append(handle)
    for runnable, handles in by_runnable.items():
        response = _worst_of(handles)
        intervals = [handle.interval for handle in handles if handle.interval]
        limit = limits.get(runnable)
        yield CallbackResult(
            name=runnable,
            process=executor.task,
            response=response,
            deadline=min(intervals, default=None) if limit is None else limit,
            reason=response.reason,
            metrics={JobMetric.RESPONSE_TIME: Metric(min=response.best, max=response.worst)},
        )


def _worst_of(handles: Sequence[HandleResult]) -> Response:
    """The response time of a callback that several handles call."""
    responses = [handle.response for handle in handles]
    unbounded = next((response for response in responses if response.worst is None), None)
    if unbounded is not None:
        return replace(unbounded, best=min(response.best for response in responses))
    longest = max(responses, key=lambda response: response.worst or 0)
    return replace(longest, best=min(response.best for response in responses))
