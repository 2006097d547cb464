"""Response times in the events executor, which calls callbacks in the order in which their events arrive.

After M. Spuri, "Analysis of deadline scheduled real-time systems", INRIA, RR-2772, 1996, with equal deadlines: a job that arrives `a`
after the begin of a busy window ends when all that arrives up to `a` is executed, whichever callback it is of. So the wait is the same
for all callbacks, and the longest one begins with an arrival.
"""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.edf import SOURCE
from amalthea_uros.analyze.response_times.fixed_priority import max_jobs
from amalthea_uros.analyze.response_times.task import FULL, AnalysedTask, Supply
from amalthea_uros.timing.response import Claim, Response

METHOD = "busy window, events in the order of their arrival"


def response_times(
    tasks: Sequence[AnalysedTask], higher: Sequence[AnalysedTask] = (), supply: Supply = FULL
) -> dict[str, Response]:
    """The response times of all callbacks of an executor, by name; there are none if the busy window is too long.

    Parameters
    ----------
    higher : the callbacks of threads that preempt the executor
    """
    length = Interference.of([*higher, *tasks], supply).window(0, 0)
    if length is None or any(task.events.eta_plus(length) > max_jobs(task) for task in tasks):
        return {}
    callbacks, preempting = Interference.of(tasks), Interference.of(higher, supply)
    arrivals = {task.events.delta_min(job) for task in tasks for job in range(1, task.events.eta_plus(length) + 1)}
    ends = {after: preempting.window(callbacks.in_window(after + 1), 0) for after in arrivals}
    worst = max((length if end is None else end) - after for after, end in ends.items())
    return {
        task.name: Response(worst=worst, best=task.demand.best, method=METHOD, source=SOURCE, claim=Claim.BOUND)
        for task in tasks
    }
