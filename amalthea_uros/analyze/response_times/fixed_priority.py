"""Response times under fixed priorities with preemption, for arbitrary deadlines.

The level-i busy window of J. P. Lehoczky, "Fixed priority scheduling of periodic task sets with arbitrary deadlines", RTSS 1990, with
jitter and blocking after K. Tindell, A. Burns and A. J. Wellings, "An extendible approach for analysing fixed priority hard real-time
tasks", Real-Time Systems 6, 1994: the q-th job of the window ends at the least w with

    w = B + C(q) + sum over higher priorities of C_j(eta_j(w))

and its response time is w minus the least time at which it can arrive. Jobs are looked at until one ends before the next can arrive.
For tasks that cannot be interrupted see `non_preemptive`.
"""

from __future__ import annotations

from amalthea_uros.analyze.response_times.best_case import best_response
from amalthea_uros.analyze.response_times.busy_window import Interference, demand_rate
from amalthea_uros.analyze.response_times.task import Task
from amalthea_uros.analyze.results import Claim, Response
from amalthea_uros.timing.event_models import Periodic
from amalthea_uros.units import Time

METHOD = "busy window, fixed priorities, preemptive"
SOURCE = "Lehoczky 1990; Tindell, Burns, Wellings 1994"
#: Busy windows with more jobs are given up; the load is then so near to 1 that the result would mean nothing.
MAX_JOBS = 20_000
#: Where arrivals are irregular each job is more work, and longer windows make what they trigger still more irregular.
MAX_IRREGULAR_JOBS = 1000


def response_time(
    task: Task, higher: Interference, blocking: Time = 0, start: Time = 0, claim: Claim = Claim.BOUND
) -> tuple[Response, Time]:
    """The response time of a task, and a lower bound for the windows of tasks below it.

    Parameters
    ----------
    start : a lower bound of the first window, such as that of the next higher task
    """
    best = best_response(task, higher)
    if higher.overloads_with(task):
        return unbounded(best, higher, task, METHOD, SOURCE), start
    worst, worst_window, worst_job = -1, 0, 0
    window = 0
    completions: list[Time] = []
    most = max_jobs(task)
    for job in range(1, most):
        found = higher.window(blocking + task.cost.max_demand(job), window if job > 1 else start)
        if found is None:
            break
        window = found
        completions.append(window)
        if window - task.arrivals.delta_min(job) > worst:
            worst, worst_window, worst_job = window - task.arrivals.delta_min(job), window, job
        if window <= task.arrivals.delta_min(job + 1):
            own = task.cost.max_demand(worst_job)
            response = Response(
                worst=worst,
                best=best,
                method=METHOD,
                source=SOURCE,
                claim=claim,
                jobs=job,
                window=worst_window,
                completions=tuple(completions),
                # The least fixed point is equal to the demand in it, so that the terms add up.
                terms={
                    "own": own,
                    "interference": worst_window - own - blocking,
                    "blocking": blocking,
                    "earlier arrival": -task.arrivals.delta_min(worst_job),
                },
            )
            return response, completions[0]
    reason = f"its busy window has more than {most:,} jobs: the demand up to this priority fills the processor"
    return Response(worst=None, best=best, method=METHOD, source=SOURCE, reason=reason), start


def max_jobs(*tasks: Task) -> int:
    """How many jobs of busy windows are looked at."""
    return MAX_JOBS if all(isinstance(task.arrivals, Periodic) for task in tasks) else MAX_IRREGULAR_JOBS


def unbounded(best: Time, higher: Interference, task: Task, method: str, source: str) -> Response:
    """What is told of a task where more is demanded than served."""
    rate = higher.rate + float(demand_rate(task))
    supplied = f"{float(higher.supply.rate):.1%} of it are granted" if higher.supply.rate < 1 else "more than there is"
    reason = f"the demand up to this priority is {rate:.1%} of the processor, {supplied}"
    return Response(worst=None, best=best, method=method, source=source, reason=reason)
