"""Response times in an executor of one thread, whatever the order of its callbacks.

After D. Casini, T. Blass, I. Luetkebohle and B. B. Brandenburg, "Response-time analysis of ROS 2 processing chains under
reservation-based scheduling", ECRTS 2019. A job that is released `a` after the start of a busy window ends within it at the least x
with

    supply(x) = own jobs released up to a + jobs of the others released before it starts, at x - C at the latest

which only needs that the executor is never idle while a callback is pending, and that callbacks do not preempt each other. So it
holds for the single-threaded, the static and the events executor of all distributions. Its bound for timers that are looked at
before each callback only holds up to dashing, and is not used. Threads that preempt the executor interfere up to x, as tasks of
higher priority do.

If the tasks have the activations of the callbacks with which their chains enter the executor, response times begin with these: the
bound of the paper for chains.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.fixed_priority import max_jobs, unbounded
from amalthea_uros.analyze.response_times.kernel import MAX_STEPS
from amalthea_uros.analyze.response_times.task import FULL, AnalysedTask, Supply
from amalthea_uros.timing.basics.time_base import LIMIT
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.units import Time

METHOD = "busy window, callbacks of an executor in any order"
SOURCE = "Casini, Blass, Luetkebohle, Brandenburg 2019"


def response_time(
    task: AnalysedTask, others: Sequence[AnalysedTask], higher: Sequence[AnalysedTask] = (), supply: Supply = FULL
) -> Response:
    """The response time of a callback.

    Parameters
    ----------
    others : the other callbacks of the executor
    higher : the callbacks of threads that preempt the executor
    """
    every, best = Interference.of([*others, *higher], supply), task.demand.best
    if every.overloads_with(task):
        return unbounded(best, every, task, METHOD, SOURCE)
    window = Interference.of([task, *others, *higher], supply).window(0, 0)
    if window is None or task.events.eta_plus(window) > max_jobs(task):
        reason = "its busy window is too long: the callbacks need nearly all of the core"
        return Response(worst=None, best=best, method=METHOD, source=SOURCE, reason=reason)
    interfering, preempting = Interference.of(others), Interference.of(higher)
    ends = [(_end(task, after, interfering, preempting, supply), after) for after in releases(task, window)]
    if any(end is None for end, _ in ends):
        reason = "its busy window does not end"
        return Response(worst=None, best=best, method=METHOD, source=SOURCE, reason=reason)
    worst = max((end or 0) - after for end, after in ends)
    return Response(worst=worst, best=best, method=METHOD, source=SOURCE, claim=Claim.BOUND, jobs=len(ends), window=window)


def releases(task: AnalysedTask, window: Time) -> Iterator[Time]:
    """The earliest release of each job in a busy window; of jobs that can be released together, that of the last one counts."""
    for job in range(1, task.events.eta_plus(window) + 1):
        yield task.events.delta_min(job)


def _end(task: AnalysedTask, after: Time, others: Interference, higher: Interference, supply: Supply) -> Time | None:
    """The latest end of the last job that is released up to `after`, from the start of the busy window."""
    own, last = task.demand.max_demand(task.events.eta_plus(after + 1)), task.demand.worst
    end = after + 1
    for _ in range(MAX_STEPS):
        reached = supply.time_for(own + others.in_window(end - last + 1) + higher.in_window(end))
        if reached <= end:
            return end
        if reached > LIMIT:
            return None
        end = reached
    return None
