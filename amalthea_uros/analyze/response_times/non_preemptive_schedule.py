"""All schedules of a core on which no task preempts another one, with releases that are known, or known but for a jitter.

Without preemption a job can end later because another one executes for a shorter time, or is released later (R. L. Graham, "Bounds on
multiprocessing timing anomalies", SIAM Journal on Applied Mathematics 17(2), 1969), so that no single schedule is the worst one, and
busy windows add up what no schedule has together. The schedules are explored as a graph of states instead.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.analyze.response_times.schedule import demand_cycle, demand_table
from amalthea_uros.analyze.response_times.schedule_abstraction import JobEnds, JobStream, explored
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.perf.activities import SchedulePoint
from amalthea_uros.perf.software import Preemption, Task
from amalthea_uros.timing.activation.releases import JitteredReleases, releases_with_jitter
from amalthea_uros.timing.blocking.critical_sections import LockUsage
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.timing.scheduling.scheduled import ScheduledProcess, preemption
from amalthea_uros.units import Time

METHOD = "all schedules until they repeat, fixed priorities, non-preemptive"
SOURCE = "Nasri, Brandenburg 2017"
ASSUMPTION = (
    "execution times with a single value are constant; without preemption, a shorter one can make other tasks later than stated"
)


@dataclass(frozen=True, slots=True, kw_only=True)
class _UnpreemptedTask:
    """A task in the time base of its core."""

    name: str
    jobs: JobStream
    demand: MultiframeDemand

    @property
    def is_known(self) -> bool:
        """Whether it is known when each job is released, and what it executes."""
        return not self.jobs.jitter and self.demand.is_certain


def scheduled_responses(core: str, solution: Solution) -> Mapping[str, Response]:
    """The response times, in picoseconds; none if the core is not of this kind, or has too many schedules.

    They are exact if all releases are known. With a jitter, exact are the ends after the earliest release; they are upper bounds of
    the times after the actual one, and are taken where they are tighter than those of the busy window.
    """
    tasks = _tasks(core, solution)
    if len(tasks) < 2 or sum(Fraction(task.demand.mean_worst, task.jobs.period) for task in tasks) > 1:
        return {}
    ends = explored([task.jobs for task in tasks])
    if ends is None or any(_may_lose(task, end, solution) for task, end in zip(tasks, ends, strict=True)):
        # Without a lost job, others can be later than in the schedules.
        return {}
    if any(shortest == longest for task in tasks for shortest, longest in task.jobs.demands):
        solution.context.notes.assume(ASSUMPTION)
    is_exact = all(task.is_known for task in tasks)
    responses, time_base = {}, solution.context.demand_model.time_base(core)
    for place, task in enumerate(tasks):
        bound = solution.responses[task.name]
        response = _response(place, tasks, ends[place], bound, time_base)
        if is_exact:
            responses[task.name] = replace(response, claim=Claim.EXACT)
        elif bound.worst is None or (response.worst or 0) < bound.worst:
            responses[task.name] = response
    return responses


def _tasks(core: str, solution: Solution) -> Sequence[_UnpreemptedTask]:
    """The tasks of a core of this kind, the most important one first; none for another one."""
    context = solution.context
    if context.decisions or context.has_loops_or_waits(core) or not solution.is_closed(core):
        return ()
    here = [item for item in context.served(core, None) if isinstance(item, ScheduledProcess)]
    if len({item.rank for item in here}) < len(context.served(core, None)) or SchedulePoint in context.system.activity_classes:
        return ()
    time_base, found = context.demand_model.time_base(core), list[_UnpreemptedTask]()
    for item in here:
        releases = releases_with_jitter(item.process, context.system)
        if releases is None or not _is_never_preempted(item, solution):
            return ()
        demand = context.demands[item.name]
        found.append(_UnpreemptedTask(name=item.name, jobs=job_stream(releases, demand, time_base), demand=demand))
    return found


def job_stream(releases: JitteredReleases, demand: MultiframeDemand, time_base: int) -> JobStream:
    """The jobs of a task in the time base of its core."""
    worst = demand_table(demand, MultiframeDemand.worst_of)
    return JobStream(
        period=releases.period * time_base,
        first=releases.earliest * time_base,
        jitter=releases.jitter * time_base,
        demands=tuple(zip(demand_table(demand, MultiframeDemand.best_of), worst, strict=True)),
        lead=len(worst) - demand_cycle(demand),
    )


def _is_never_preempted(item: ScheduledProcess, solution: Solution) -> bool:
    """Whether a process is known, is never preempted, and locks nothing."""
    return (
        preemption(item) is Preemption.NON_PREEMPTIVE
        and item.group is None
        and item.name in solution.responses
        and solution.is_analysable(item.name)
        and solution.context.protection[item.name] == LockUsage()
    )


def _may_lose(task: _UnpreemptedTask, ends: JobEnds, solution: Solution) -> bool:
    """Whether more jobs of a task are pending than its activation limit allows."""
    process = solution.context.scheduled[task.name].process
    return isinstance(process, Task) and -(-ends.latest // task.jobs.period) > process.activation_limit


def _response(place: int, tasks: Sequence[_UnpreemptedTask], ends: JobEnds, bound: Response, time_base: int) -> Response:
    jobs = tasks[place].jobs
    longest, own = -(-ends.latest // time_base), -(-jobs.demand(ends.job)[1] // time_base)
    blocked = min(-(-_blocking(place, tasks, ends) // time_base), longest - own)
    return replace(
        bound,
        worst=longest,
        best=max(bound.best, ends.earliest // time_base),
        method=METHOD,
        source=SOURCE,
        claim=Claim.BOUND,
        jobs=ends.jobs,
        window=longest,
        completions=(),
        terms={"own": own, "interference": longest - own - blocked, "blocking": blocked},
        reason="",
        is_overload=False,
    )


def _blocking(place: int, tasks: Sequence[_UnpreemptedTask], ends: JobEnds) -> Time:
    """How long a job of lower priority executes after the release of the job that ends the latest, in the schedule in which it does."""
    release, before = tasks[place].jobs.first + ends.job * tasks[place].jobs.period, ends.history
    while before is not None:
        task, start, end, before = before
        if task > place:
            return max(0, end - max(release, start))
        if start < release:
            break
    return 0
