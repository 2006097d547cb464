"""Response times of tasks that cannot be interrupted, and of CAN frames.

After R. I. Davis, A. Burns, R. J. Bril and J. J. Lukkien, "Controller Area Network (CAN) schedulability analysis: Refuted, revisited
and revised", Real-Time Systems 35, 2007, section 3: all jobs of the busy period are looked at, since a later one may wait longer than
the first, because its predecessor pushes higher priorities into it. The q-th job starts at the least w with

    w = B + C(q - 1) + sum over higher priorities of C_j(eta_j(w + step))

where step is the shortest time after which an arrival is too late: one bit on CAN, one unit of time on a processor. A task that can be
interrupted at some points only starts its last region in the same way, with C(q) less that region before it; while it runs, those
interrupt it that always may.
"""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.fixed_priority import max_jobs, unbounded
from amalthea_uros.analyze.response_times.task import Task
from amalthea_uros.analyze.results import Claim, Response
from amalthea_uros.units import Time

METHOD = "busy period, fixed priorities, non-preemptive"
SOURCE = "Davis, Burns, Bril, Lukkien 2007"


def response_times(tasks: Sequence[Task], step: Time = 1) -> list[Response]:
    """The response times of tasks of which none interrupts another one, in the order given."""
    found = []
    for task in tasks:
        higher = [other for other in tasks if other is not task and other.priority >= task.priority]
        lower = [other for other in tasks if other.priority < task.priority]
        found.append(response_time(task, higher, max((other.cost.worst for other in lower), default=0), step))
    return found


def response_time(
    task: Task,
    higher: Sequence[Task],
    blocking: Time,
    step: Time = 1,
    last: Time | None = None,
    always: Sequence[Task] = (),
) -> Response:
    """The response time of a task that cannot be interrupted, among others that may interrupt each other or not.

    Parameters
    ----------
    last : its last region without interruption; None: the whole task
    always : those among the higher ones that interrupt it nevertheless
    """
    last = task.cost.worst if last is None else last
    others, interrupting = Interference.of(higher), Interference.of(always)
    if others.overloads_with(task):
        return unbounded(task.cost.best, others, task, METHOD, SOURCE)
    most = max_jobs(task)
    period = Interference.of([*higher, task]).window(blocking, 0)
    if period is None or (jobs := task.arrivals.eta_plus(period)) > most:
        reason = f"its busy period has more than {most:,} jobs: the demand up to this priority fills the capacity"
        return Response(worst=None, best=task.cost.best, method=METHOD, source=SOURCE, reason=reason)
    completions: list[Time] = []
    start = 0
    for job in range(1, jobs + 1):
        start = _start(others, blocking + task.cost.max_demand(job) - last, start, step)
        completions.append(_end(interrupting, start, last, step))
    worst_job = max(range(1, jobs + 1), key=lambda job: completions[job - 1] - task.arrivals.delta_min(job))
    window, own = completions[worst_job - 1], task.cost.max_demand(worst_job)
    return Response(
        worst=window - task.arrivals.delta_min(worst_job),
        best=task.cost.best,
        method=METHOD,
        source=SOURCE,
        claim=Claim.EXACT,
        jobs=jobs,
        window=window,
        completions=tuple(completions),
        terms={
            "own": own,
            "interference": window - own - blocking,
            "blocking": blocking,
            "earlier arrival": -task.arrivals.delta_min(worst_job),
        },
    )


def _start(others: Interference, before: Time, lower: Time, step: Time) -> Time:
    """The least time at which everything before is done and nothing of higher priority has arrived."""
    start = max(before, lower)
    while True:
        reached = before + others.in_window(start + step)
        if reached <= start:
            return start
        start = reached


def _end(interrupting: Interference, start: Time, last: Time, step: Time) -> Time:
    """The end of the last region, with those that arrive behind its start and interrupt it."""
    before = interrupting.in_window(start + step)
    end = start + last
    while True:
        reached = start + last + max(0, interrupting.in_window(end) - before)
        if reached <= end:
            return end
        end = reached
