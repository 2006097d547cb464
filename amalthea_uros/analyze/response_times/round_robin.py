"""Response times of tasks of equal priority under round robin.

After R. Racu, L. Li, R. Henia, A. Hamann and R. Ernst, "Improved response time analysis of tasks scheduled under preemptive
round-robin", CODES+ISSS 2007: before each slice of a task, every other task of its priority gets at most one slice, and in total
no more than its demand.
"""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.analyze.response_times.busy_window import Interference, demand_rate
from amalthea_uros.analyze.response_times.fixed_priority import max_jobs, unbounded
from amalthea_uros.analyze.response_times.kernel import MAX_STEPS
from amalthea_uros.analyze.response_times.task import Task
from amalthea_uros.analyze.results import Claim, Response
from amalthea_uros.timing.limits import LIMIT
from amalthea_uros.units import Time

METHOD = "busy window, round robin"
SOURCE = "Racu, Li, Henia, Hamann, Ernst 2007"


def response_time(task: Task, others: Sequence[Task], higher: Interference, blocking: Time = 0) -> Response:
    """The response time of a task among others of its priority.

    Parameters
    ----------
    higher : tasks of higher priority
    """
    if _overloads(task, others, higher):
        return unbounded(task.demand.best, Interference.of([*higher.tasks, *others], higher.supply), task, METHOD, SOURCE)
    completions: list[Time] = []
    for job in range(1, max_jobs(task)):
        end = _end(task, job, others, higher, blocking)
        if end > LIMIT:
            break
        completions.append(end)
        if end <= task.events.delta_min(job + 1):
            return _response(task, completions, blocking)
    reason = "its busy window does not end: the tasks need all of the core"
    return Response(worst=None, best=task.demand.best, method=METHOD, source=SOURCE, reason=reason)


def _overloads(task: Task, others: Sequence[Task], higher: Interference) -> bool:
    """Whether a task gets less than its demand; slices limit what other tasks of its priority take."""
    own = demand_rate(task)
    between = sum((min(own * other.slice / task.slice, demand_rate(other)) for other in others), own)
    return sum(map(demand_rate, higher.tasks), between) > higher.supply.rate


def _end(task: Task, job: int, others: Sequence[Task], higher: Interference, blocking: Time) -> Time:
    own = task.demand.max_demand(job)
    slices = -(-own // task.slice)
    end = 0
    for _ in range(MAX_STEPS):
        between = sum(min(slices * other.slice, other.demand.max_demand(other.events.eta_plus(end))) for other in others)
        reached = higher.window(blocking + own + between, end)
        if reached is None:
            break
        if reached == end:
            return end
        end = reached
    return LIMIT + 1


def _response(task: Task, completions: Sequence[Time], blocking: Time) -> Response:
    worst_job = max(range(1, len(completions) + 1), key=lambda job: completions[job - 1] - task.events.delta_min(job))
    window, own, earlier = completions[worst_job - 1], task.demand.max_demand(worst_job), task.events.delta_min(worst_job)
    return Response(
        worst=window - earlier,
        best=task.demand.best,
        method=METHOD,
        source=SOURCE,
        claim=Claim.BOUND,
        jobs=len(completions),
        window=window,
        completions=tuple(completions),
        terms={"own": own, "interference": window - own - blocking, "blocking": blocking, "earlier arrival": -earlier},
    )
