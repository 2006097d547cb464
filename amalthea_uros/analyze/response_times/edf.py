"""Response times under earliest deadline first.

After M. Spuri, "Analysis of deadline scheduled real-time systems", INRIA, RR-2772, 1996: the
worst response of a job that is activated `a` after the start of a busy window in which all others are activated as early as
possible; only those of them count whose deadline is not later. Tasks of higher priority come first.

The activations `a` to be considered are those at which the deadline of the job meets that of another one, or at which it is one of the
earliest that its own task can have.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.fixed_priority import max_jobs, unbounded
from amalthea_uros.analyze.response_times.kernel import MAX_STEPS
from amalthea_uros.analyze.response_times.task import Task
from amalthea_uros.analyze.results import Claim, Response
from amalthea_uros.timing.limits import LIMIT
from amalthea_uros.units import Time

METHOD = "busy window, earliest deadline first"
SOURCE = "Spuri 1996"


def response_time(
    task: Task, others: Sequence[Task], higher: Interference, blocking: Time = 0, method: str = METHOD
) -> Response:
    """The response time of a task among others of its priority.

    Parameters
    ----------
    higher : tasks of higher priority
    """
    level = [task, *others]
    together = Interference.of([*higher.tasks, *others], higher.supply)
    if together.overloads_with(task):
        return unbounded(task.cost.best, together, task, method, SOURCE)
    window = Interference.of([*higher.tasks, *level], higher.supply).window(blocking, 0)
    most = max_jobs(*level)
    arrivals = sorted(set(_arrivals(task, level, window, most))) if window is not None else []
    if not arrivals or len(arrivals) > most:
        reason = f"more than {most:,} arrivals in its busy window: the demand fills the processor"
        return Response(worst=None, best=task.cost.best, method=method, source=SOURCE, reason=reason)
    ends = [(_end(task, arrival, others, higher, blocking), arrival) for arrival in arrivals]
    if any(end > LIMIT for end, _ in ends):
        return Response(worst=None, best=task.cost.best, method=method, source=SOURCE, reason="its busy window does not end")
    end, arrival = max(ends, key=lambda pair: pair[0] - pair[1])
    # A window that ends before the job arrives says that nothing is in its way.
    worst = max(end - arrival, higher.supply.time_for(task.cost.worst))
    return Response(
        worst=worst,
        best=task.cost.best,
        method=method,
        source=SOURCE,
        claim=Claim.BOUND,
        jobs=len(arrivals),
        window=end,
        terms={"own": task.cost.worst, "interference": worst - task.cost.worst - blocking, "blocking": blocking},
    )


def _arrivals(task: Task, level: Iterable[Task], window: Time, most: int) -> Iterator[Time]:
    """Where in the busy window an arrival of the task may be the worst one."""
    yield 0
    for other in level:
        later = other.deadline - task.deadline
        for count in range(1, most + 2):
            arrival = other.arrivals.delta_min(count) + later
            if arrival >= window:
                break
            if arrival > 0:
                yield arrival


def _end(task: Task, arrival: Time, others: Sequence[Task], higher: Interference, blocking: Time) -> Time:
    """The end of the busy window in which everything is served that comes no later than a job."""
    own = task.cost.max_demand(task.arrivals.eta_plus(arrival + 1))
    # As many of each other task have a deadline that is not later; arrivals at the end of that time count.
    limits = [(other, other.arrivals.eta_plus(arrival + task.deadline - other.deadline + 1)) for other in others]
    end = 0
    for _ in range(MAX_STEPS):
        before = sum(other.cost.max_demand(min(limit, other.arrivals.eta_plus(end))) for other, limit in limits if limit > 0)
        reached = higher.window(blocking + own + before, end)
        if reached is None:
            return LIMIT + 1
        if reached == end:
            return end
        end = reached
    return LIMIT + 1
