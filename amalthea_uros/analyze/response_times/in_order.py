"""Response times where jobs of the same priority are served in an order that is fixed when they arrive.

By deadlines (earliest deadline first) after M. Spuri, "Analysis of deadline scheduled real-time systems", INRIA, RR-2772, 1996: the
worst response of a job that arrives `a` behind the start of a busy window in which all others arrive as early as they can, and only
those of them count whose deadline is not later. First come, first served is the same with all deadlines alike. What has a higher
priority comes first in both.

The arrivals `a` that have to be looked at are those at which the deadline of the job meets that of another one, or at which it is one
of the earliest that its own task can have.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.fixed_priority import most_jobs, unbounded
from amalthea_uros.analyze.response_times.kernel import LIMIT, MOST_STEPS
from amalthea_uros.analyze.response_times.task import Claim, Response, Sharing, Task
from amalthea_uros.units import Time

METHODS = {
    Sharing.ARRIVAL: "busy window, fixed priorities, first come first served within one",
    Sharing.DEADLINE: "busy window, earliest deadline first",
}
SOURCE = "Spuri 1996"


def response_time(task: Task, others: Sequence[Task], higher: Interference, blocking: Time = 0) -> Response:
    """The response time of a task among others of its priority.

    Parameters
    ----------
    higher : what comes before all of them
    """
    method = METHODS[task.sharing]
    level = [task, *others]
    together = Interference.of([*higher.tasks, *others], higher.supply)
    if together.overloads_with(task):
        return unbounded(task.cost.best, together, task, method, SOURCE)
    window = Interference.of([*higher.tasks, *level], higher.supply).window(blocking, 0)
    most = most_jobs(*level)
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
            arrival = other.arrivals.span(count) + later
            if arrival >= window:
                break
            if arrival > 0:
                yield arrival


def _end(task: Task, arrival: Time, others: Sequence[Task], higher: Interference, blocking: Time) -> Time:
    """The end of the busy window in which everything is served that comes no later than a job."""
    own = task.cost.most(task.arrivals.most(arrival + 1))
    # As many of each other task have a deadline that is not later; arrivals at the end of that time count.
    limits = [(other, other.arrivals.most(arrival + task.deadline - other.deadline + 1)) for other in others]
    end = 0
    for _ in range(MOST_STEPS):
        before = sum(other.cost.most(min(limit, other.arrivals.most(end))) for other, limit in limits if limit > 0)
        reached = higher.window(blocking + own + before, end)
        if reached is None:
            return LIMIT + 1
        if reached == end:
            return end
        end = reached
    return LIMIT + 1
