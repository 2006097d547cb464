"""Response times under earliest deadline first.

After M. Spuri, "Analysis of deadline scheduled real-time systems", INRIA, RR-2772, 1996: the
worst-case response time of a job that is activated `a` after the start of a busy window in which all others are activated as early as
possible; only those with an earlier or equal deadline interfere. Tasks of higher priority are served first.

The candidates for `a` are the times at which the deadline of the job coincides with that of another one, or at which the job is one of
the earliest of its own task.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence

from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.fixed_priority import max_jobs, unbounded
from amalthea_uros.analyze.response_times.kernel import MAX_STEPS
from amalthea_uros.analyze.response_times.task import AnalysedTask
from amalthea_uros.timing.basics.time_base import LIMIT
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.units import Time

METHOD = "busy window, earliest deadline first"
#: First come, first served is the same with equal deadlines.
FIFO_METHOD = "busy window, fixed priorities, first come first served within one"
SOURCE = "Spuri 1996"


def response_time(
    task: AnalysedTask,
    others: Sequence[AnalysedTask],
    higher: Interference,
    blocking: Time = 0,
    method: str = METHOD,
    blocking_before: Callable[[Time], Time] = lambda _: 0,
) -> Response:
    """The response time of a task among others of its priority.

    Parameters
    ----------
    higher : tasks of higher priority
    blocking : by tasks of lower priority
    blocking_before : blocking by jobs whose deadline is later than a time after the start of the busy window
    """
    level = [task, *others]
    together = Interference.of([*higher.tasks, *others], higher.supply)
    if together.overloads_with(task):
        return unbounded(task.demand.best, together, task, method, SOURCE)
    longest_blocking = max(blocking, *(blocking_before(each.deadline) for each in level))
    window = Interference.of([*higher.tasks, *level], higher.supply).window(longest_blocking, 0)
    limit = max_jobs(*level)
    candidates = sorted(set(_candidates(task, level, window, limit))) if window is not None else []
    if not candidates or len(candidates) > limit:
        reason = f"its busy window has more than {limit:,} activations: the tasks need nearly all of the core"
        return Response(worst=None, best=task.demand.best, method=method, source=SOURCE, reason=reason)
    blocked = [max(blocking, blocking_before(activation + task.deadline)) for activation in candidates]
    ends = [
        (_end(task, activation, others, higher, wait), activation, wait)
        for activation, wait in zip(candidates, blocked, strict=True)
    ]
    if any(end > LIMIT for end, _, _ in ends):
        return Response(worst=None, best=task.demand.best, method=method, source=SOURCE, reason="its busy window does not end")
    end, activation, waiting = max(ends, key=lambda found: found[0] - found[1])
    # If the window ends before the job is activated, nothing delays the job.
    worst = max(end - activation, higher.supply.time_for(task.demand.worst))
    return Response(
        worst=worst,
        best=task.demand.best,
        method=method,
        source=SOURCE,
        claim=Claim.BOUND,
        jobs=len(candidates),
        window=end,
        terms={"own": task.demand.worst, "interference": worst - task.demand.worst - waiting, "blocking": waiting},
    )


def _candidates(task: AnalysedTask, level: Iterable[AnalysedTask], window: Time, limit: int) -> Iterator[Time]:
    """The activation times in the busy window that can give the worst case."""
    yield 0
    for other in level:
        later = other.deadline - task.deadline
        for count in range(1, limit + 2):
            activation = other.events.delta_min(count) + later
            if activation >= window:
                break
            if activation > 0:
                yield activation


def _end(task: AnalysedTask, activation: Time, others: Sequence[AnalysedTask], higher: Interference, blocking: Time) -> Time:
    """The end of the busy window that serves a job and all jobs with earlier or equal deadlines."""
    own = task.demand.max_demand(task.events.eta_plus(activation + 1))
    # Number of jobs of each other task with an earlier or equal deadline; an activation at the end of that time counts.
    limits = [(other, other.events.eta_plus(activation + task.deadline - other.deadline + 1)) for other in others]
    end = 0
    for _ in range(MAX_STEPS):
        before = sum(other.demand.max_demand(min(limit, other.events.eta_plus(end))) for other, limit in limits if limit > 0)
        reached = higher.window(blocking + own + before, end)
        if reached is None:
            return LIMIT + 1
        if reached == end:
            return end
        end = reached
    return LIMIT + 1
