"""Response times under fixed priorities with preemption, for arbitrary deadlines.

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

from amalthea_uros.analyze.response_times.busy_window import Interference, demand_rate
from amalthea_uros.analyze.response_times.kernel import greatest_fixed_point
from amalthea_uros.analyze.response_times.task import AnalysedTask
from amalthea_uros.timing.basics.time_base import LIMIT
from amalthea_uros.timing.event_models import PeriodicEvents
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.units import Time, percent_text

METHOD = "busy window, fixed priorities, preemptive"
SOURCE = "Lehoczky 1990; Tindell, Burns, Wellings 1994"
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
    worst, worst_window, worst_job = -1, 0, 0
    window = 0
    completions: list[Time] = []
    limit = max_jobs(task)
    for job in range(1, limit):
        found = higher.window(blocking + task.demand.max_demand(job), window if job > 1 else start)
        if found is None:
            break
        window = found
        completions.append(window)
        if window - task.events.delta_min(job) > worst:
            worst, worst_window, worst_job = window - task.events.delta_min(job), window, job
        if window <= task.events.delta_min(job + 1):
            own = task.demand.max_demand(worst_job)
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
                    "earlier arrival": -task.events.delta_min(worst_job),
                },
            )
            return response, completions[0]
    reason = f"its busy window has more than {limit:,} jobs: tasks at this priority or higher need nearly all of the core"
    return Response(worst=None, best=best, method=METHOD, source=SOURCE, reason=reason), start


def max_jobs(*tasks: AnalysedTask) -> int:
    """Maximum number of jobs of a busy window that are examined."""
    return MAX_JOBS if all(isinstance(task.events, PeriodicEvents) for task in tasks) else MAX_IRREGULAR_JOBS


def unbounded(best: Time, higher: Interference, task: AnalysedTask, method: str, source: str) -> Response:
    """The response time of a task that is overloaded together with those of higher priority."""
    rate = higher.rate + float(demand_rate(task))
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
