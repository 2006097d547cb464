"""Response times of non-preemptive tasks and CAN frames.

After R. I. Davis, A. Burns, R. J. Bril and J. J. Lukkien, "Controller Area Network (CAN) schedulability analysis: Refuted, revisited
and revised", Real-Time Systems 35, 2007, section 3: all jobs of the busy period are examined, because a later one can wait longer than
the first: the previous job delays tasks of higher priority. The q-th job starts at the least w with

    w = B + C(q - 1) + sum over higher priorities of C_j(eta_j(w + granularity))

where the granularity is the shortest time after which an activation is too late: one bit on CAN, one unit of time on a core. A task
with preemption points starts its last non-preemptive region in the same way, after C(q) minus that region; during the region, only
tasks that can always preempt it interfere.
"""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.fixed_priority import max_jobs, of_completions, unbounded
from amalthea_uros.analyze.response_times.task import AnalysedTask
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.units import Time

METHOD = "busy period, fixed priorities, non-preemptive"
SOURCE = "Davis, Burns, Bril, Lukkien 2007"


def response_times(tasks: Sequence[AnalysedTask], granularity: Time = 1) -> list[Response]:
    """The response times of non-preemptive tasks, in the given order."""
    found = []
    for task in tasks:
        higher = [other for other in tasks if other is not task and other.priority >= task.priority]
        lower = [other for other in tasks if other.priority < task.priority]
        found.append(response_time(task, higher, max((other.demand.worst for other in lower), default=0), granularity))
    return found


def response_time(
    task: AnalysedTask,
    higher: Sequence[AnalysedTask],
    blocking: Time,
    granularity: Time = 1,
    last_region: Time | None = None,
    always_preempting: Sequence[AnalysedTask] = (),
) -> Response:
    """The response time of a task with a non-preemptive last region, among tasks of any kind.

    Parameters
    ----------
    granularity : shortest time after which an activation is too late
    last_region : its last non-preemptive region; None: the whole task
    always_preempting : tasks among the higher ones that preempt it nevertheless
    """
    before = 0 if last_region is None else task.demand.worst - last_region
    others, interrupting = Interference.of(higher), Interference.of(always_preempting)
    if others.overloads_with(task):
        return unbounded(task.demand.best, others, task, METHOD, SOURCE)
    limit = max_jobs(task)
    period = Interference.of([*higher, task]).window(blocking, 0, task.events.delta_min(limit + 1))
    if period is None or (jobs := task.events.eta_plus(period)) > limit:
        reason = f"its busy period has more than {limit:,} jobs: tasks at this priority or higher need nearly all of the core"
        return Response(worst=None, best=task.demand.best, method=METHOD, source=SOURCE, reason=reason)
    completions: list[Time] = []
    start = 0
    for job in range(1, jobs + 1):
        # With counters, the earlier jobs can be the longer ones: the last region is what these do not take.
        last = max(0, task.demand.max_demand(job) - task.demand.max_demand(job - 1) - before)
        start = _start(others, blocking + task.demand.max_demand(job) - last, start, granularity)
        completions.append(_end(interrupting, start, last, granularity))
    return of_completions(task, completions, blocking, METHOD, SOURCE, Claim.EXACT)


def _start(others: Interference, before: Time, lower: Time, granularity: Time) -> Time:
    """The earliest time at which all earlier demand is served and no task of higher priority is pending."""
    start = max(before, lower)
    while True:
        reached = before + others.in_window(start + granularity)
        if reached <= start:
            return start
        start = reached


def _end(interrupting: Interference, start: Time, last: Time, granularity: Time) -> Time:
    """The end of the last region, including tasks that are activated after its start and preempt it."""
    before = interrupting.in_window(start + granularity)
    end = start + last
    while True:
        reached = start + last + max(0, interrupting.in_window(end) - before)
        if reached <= end:
            return end
        end = reached
