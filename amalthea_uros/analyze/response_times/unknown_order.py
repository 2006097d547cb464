"""Response times of tasks for which the order of priorities is not stated.

A core that is never idle while a job is pending executes in a busy period only what is activated in it. So the q-th job of a task
ends, at the latest, when the first q jobs and all jobs of the others that are activated until then fit into the window:

    w = B + C(q) + sum over all others of C_j(eta_j(w))

That is the busy window of the task as the lowest one (J. P. Lehoczky, "Fixed priority scheduling of periodic task sets with arbitrary
deadlines", RTSS 1990), and holds for each order of priorities, also if tasks share one or keep each other off. As the highest one, the
task needs its own execution time only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from amalthea_uros.analyze.response_times import fixed_priority
from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.task import AnalysedTask
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.units import Time

METHOD = "busy window, any order of priorities"
ASSUMPTION = "where tasks of a scheduler have no priority, the response times of all its tasks hold for any order of priorities"


def response_time(task: AnalysedTask, others: Sequence[AnalysedTask], higher: Interference, blocking: Time = 0) -> Response:
    """The response time of a task among others of an unknown order; see `fixed_priority.response_time`."""
    above = Interference.of([*higher.tasks, *others], higher.supply)
    found, _ = fixed_priority.response_time(task, above, blocking)
    if found.is_overload:
        # Which of the tasks is the lowest is unknown.
        reason = f"as the lowest, it has no bound: {found.reason.removeprefix('overload: ')}"
        found = replace(found, is_overload=False, reason=reason)
    return replace(found, best=task.demand.best, method=METHOD, claim=Claim.BOUND)
