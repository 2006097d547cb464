"""Response times under fixed priorities with preemption, for arbitrary deadlines, and what else the same busy window bounds.

The level-i busy window of J. P. Lehoczky, "Fixed priority scheduling of periodic task sets with arbitrary deadlines", RTSS 1990, with
jitter and blocking after K. Tindell, A. Burns and A. J. Wellings, "An extendible approach for analysing fixed priority hard real-time
tasks", Real-Time Systems 6, 1994: the q-th job of the window ends at the least w with

    w = B + C(q) + sum over higher priorities of C_j(eta_j(w))

and its response time is w minus its earliest activation. Jobs are examined until one ends before the next can be activated. For
non-preemptive tasks see `non_preemptive`.

Best cases after O. Redell and M. Sanfridson, "Exact best-case response time analysis of fixed priority scheduled tasks", ECRTS 2002:
the greatest fixed point of R = C + sum over higher priorities of C_j * (ceil(R / T_j) - 1), the interference that is unavoidable in R.
Tasks with jitter or without a maximum time between activations are ignored; then the value is a lower bound. It holds once all tasks
have been released: the first jobs of a system can run before other tasks have started.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from amalthea_uros.analyze.response_times.blocking import Blocking
from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.kernel import greatest_fixed_point
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.response_times.task import AnalysedTask, Supply
from amalthea_uros.timing.basics.time_base import LIMIT
from amalthea_uros.timing.event_models.models import PeriodicEvents
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.timing.scheduling.scheduled import ScheduledProcess
from amalthea_uros.units import Time, percent_text

METHOD = "busy window, fixed priorities, preemptive"
SOURCE = "Lehoczky 1990; Tindell, Burns, Wellings 1994"
ANY_ORDER = "busy window, any order of priorities"
BUSY_PERIOD = "longest busy period, of jobs that exclude each other the longest"
ASSUMPTION = (
    "where tasks of a scheduler have no priority, or no deadline that it knows, the response times of all its tasks hold for any "
    "order of priorities that keeps the stated ones"
)
#: Busy windows with more jobs are considered unbounded: the load is then so close to 1 that a bound would be useless.
MAX_JOBS = 20_000
#: The limit for irregular activations: each job takes longer to compute, and long windows increase the jitter of triggered tasks.
MAX_IRREGULAR_JOBS = 1000


def response_time(
    task: AnalysedTask, higher: Interference, blocking: Time = 0, start: Time = 0, claim: Claim = Claim.BOUND
) -> tuple[Response, Time]:
    """The response time of a task, and a lower bound for the windows of tasks below it.

    Parameters
    ----------
    start : a lower bound of the first window, such as that of the next higher task
    """
    best = best_response(task, higher)
    if higher.overloads_with(task):
        return unbounded(best, higher, task, METHOD, SOURCE), start
    completions: list[Time] = []
    limit = max_jobs(task)
    # No window can end before one of the jobs after it if it is longer than the distance of the last one.
    horizon = task.events.delta_min(limit)
    for job in range(1, limit):
        window = higher.window(blocking + task.demand.max_demand(job), completions[-1] if completions else start, horizon)
        if window is None:
            break
        completions.append(window)
        if task.is_alone or window <= task.events.delta_min(job + 1):
            found = of_completions(task, completions, blocking, METHOD, SOURCE, claim)
            return replace(found, best=best), completions[0]
    reason = f"its busy window has more than {limit:,} jobs: tasks at this priority or higher need nearly all of the core"
    return Response(worst=None, best=best, method=METHOD, source=SOURCE, reason=reason), start


def of_completions(
    task: AnalysedTask, completions: Sequence[Time], blocking: Time, method: str, source: str, claim: Claim = Claim.BOUND
) -> Response:
    """The response time of a task of which these are the ends of all jobs in its busy window; each is the demand up to it."""

    def response(job: int) -> Time:
        return completions[job - 1] - task.events.delta_min(job)

    worst_job = max(range(1, len(completions) + 1), key=response)
    window, own = completions[worst_job - 1], task.demand.max_demand(worst_job)
    return Response(
        worst=response(worst_job),
        best=task.demand.best,
        method=method,
        source=source,
        claim=claim,
        jobs=len(completions),
        window=window,
        completions=tuple(completions),
        terms={
            "own": own,
            "interference": window - own - blocking,
            "blocking": blocking,
            "earlier arrival": -task.events.delta_min(worst_job),
        },
    )


def in_any_order(task: AnalysedTask, others: Sequence[AnalysedTask], higher: Interference, blocking: Time = 0) -> Response:
    """The response time of a task among others, where it is not stated which of them is above it.

    A core that is never idle while a job is pending executes in a busy period only what is activated in it. So the busy window of
    the task as the lowest one holds for each order of priorities, also if tasks share one or keep each other off, and if the order
    changes from job to job, as with deadlines: it counts only on the jobs of one task being served in their order. As the highest
    one, the task needs its own execution time only.
    """
    found, _ = response_time(task, Interference.of([*higher.tasks, *others], higher.supply), blocking)
    if found.is_overload:
        # Which of the tasks is the lowest is unknown.
        where = "as the lowest" if task.place is None else "in the worst order"
        reason = f"{where}, it has no bound: {found.reason.removeprefix('overload: ')}"
        found = replace(found, is_overload=False, reason=reason)
    return replace(found, best=task.demand.best, method=ANY_ORDER, claim=Claim.BOUND)


def in_busy_period(
    task: AnalysedTask, level: Sequence[AnalysedTask], blocking: Time, supply: Supply, other: Response
) -> Response:
    """The longest busy period of a level, in which each of its jobs ends, in whatever order they are served.

    It is the least fixed point of what is activated in it (Lehoczky 1990). Of jobs that exclude each other, because a process
    triggers only some of them, it serves one that takes as long as the longest path: it is bounded even where the sum of all paths
    overloads the core.

    Parameters
    ----------
    level : what is served before the end of the busy period, including the task, alone or with others
    other : the result of another method, if this one gives no bound
    """
    if sum(each.demand_rate for each in level) > supply.rate:
        return other
    window = Interference.of(level, supply).window(blocking, 1)
    if window is None:
        return other
    own = task.demand.worst
    return Response(
        worst=window,
        best=other.best,
        method=BUSY_PERIOD,
        source="Lehoczky 1990",
        claim=Claim.BOUND,
        window=window,
        terms={"own": own, "interference": window - own - blocking, "blocking": blocking},
    )


def max_jobs(*tasks: AnalysedTask) -> int:
    """Maximum number of jobs of a busy window that are examined."""
    return MAX_JOBS if all(isinstance(task.events, PeriodicEvents) for task in tasks) else MAX_IRREGULAR_JOBS


def unbounded(best: Time, higher: Interference, task: AnalysedTask, method: str, source: str) -> Response:
    """The response time of a task that is overloaded together with those of higher priority."""
    rate = higher.rate + float(task.demand_rate)
    reason = f"overload: tasks at this priority or higher need {percent_text(rate, 1)} % of the core"
    if higher.supply.rate < 1:
        reason += f", and their server provides {percent_text(higher.supply.rate, 1)} %"
    return Response(worst=None, best=best, method=method, source=source, reason=reason, is_overload=True)


def best_response(task: AnalysedTask, higher: Interference) -> Time:
    """A lower bound of the response time once all tasks have been released; exact for periodic tasks with unknown offsets."""
    own, rows = task.demand.best, higher.rows
    if higher.best_rate >= 1 or not higher.is_countable:
        return own
    # There is no greater fixed point, because R <= C + rate * R.
    start = int(own / (1 - higher.best_rate)) + 1
    if start > LIMIT:
        return own
    return greatest_fixed_point(own, start, rows.periods, rows.best, higher.row_count)


def time_until_executed(name: str, executed: Time, solution: Solution) -> Time | None:
    """The maximum time from the activation of a process to what follows a part of its demand, in the time base of its core.

    The busy window with only this part of the last job: as long as that has not been executed, the core serves earlier jobs, tasks of
    higher priority, or the one task of lower priority that blocks. This holds for tasks of any preemption mode, because none lets
    tasks of lower priority go first once it has started; only the advantage of not being preempted is given away.

    An access after that part takes no time, and the job may make it only when it has the core again: what arrives at the end of the
    window counts, too. Since times are integers, this is the window up to the beginning of one unit more.

    None where the busy window does not follow the jobs of a process: under other policies, with equal priorities, in servers, where a
    scheduler takes time to decide, and where somebody can wait for a semaphore in the middle of a job.

    Parameters
    ----------
    executed : the worst-case demand of that part, in the time base; 0 for the start of the job
    """
    context = solution.context
    scheduled = context.scheduled[name]
    here = context.served(scheduled.core, scheduled.server)
    processes = [item for item in here if isinstance(item, ScheduledProcess)]
    if scheduled.server is not None or len(processes) < len(here) or any(item.name in context.decisions for item in here):
        return None
    blocking = Blocking.of(processes, solution)
    level = blocking.level(scheduled)
    above = [item for item in processes if item.rank >= level.rank and item.name != name]
    if level.is_flat or any(item.rank == scheduled.rank for item in above) or blocking.obstacle(scheduled):
        return None
    task, *higher = (AnalysedTask.of(item, solution) for item in (scheduled, *above))
    interference, wait = Interference.of(higher), blocking.time(scheduled)
    longest: Time = 0
    for job in range(1, max_jobs(task)):
        window = interference.window(wait + task.demand.max_demand(job), 0)
        part = interference.window(wait + task.demand.max_demand(job - 1) + executed + 1, 0)
        if window is None or part is None:
            return None
        longest = max(longest, part - 1 - task.events.delta_min(job))
        if window <= task.events.delta_min(job + 1):
            return longest
    return None
