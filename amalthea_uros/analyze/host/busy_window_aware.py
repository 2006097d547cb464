"""The calls of the other callbacks in a busy window: for what is released before a callback is, and at polling points from then on.

After T. Blass et al., RTSS 2021 (see `starvation_free`), the busy-window-aware analysis. If a job is released `a` after the begin of
a busy window, each other callback is called for what is released up to `a`, and then once for each polling point at most.
"""

from __future__ import annotations

from collections.abc import Mapping

from amalthea_uros.analyze.host.starvation_free import ReadySet
from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.task import FULL
from amalthea_uros.units import Time

METHOD = "busy window, polling points while a callback is pending"

#: With more times at which the job can be released, nothing is improved: each of them takes a fixed point.
_MOST_RELEASES = 500


def latest(index: int, ready: ReadySet, known: Mapping[str, Time]) -> Time:
    """The response time of a callback if those of all are known."""
    task, limit = ready.tasks[index], known[ready.tasks[index].name]
    calls = task.events.eta_plus(limit)
    # If no more is released than can be called, the bound for any order is as good, unless there is a reservation.
    if ready.supply is FULL and all(other.events.eta_plus(limit) <= calls for other in ready.tasks):
        return limit
    window = Interference.of(ready.tasks, ready.supply).window(0, 0)
    if window is None or _has_too_many_releases(ready, window):
        return limit
    return max(min(limit, _latest_after(after, index, ready, known)) for after in _releases(ready, window))


def why_not_used(ready: ReadySet) -> str:
    """Why a smaller bound is not looked for; "" if it is."""
    window = Interference.of(ready.tasks, ready.supply).window(0, 0)
    if window is None or not _has_too_many_releases(ready, window):
        return ""
    return f"its longest busy window has more than {_MOST_RELEASES} releases"


def _has_too_many_releases(ready: ReadySet, window: Time) -> bool:
    return sum(task.events.eta_plus(window) for task in ready.tasks) > _MOST_RELEASES


def _releases(ready: ReadySet, window: Time) -> set[Time]:
    """The times from the begin of a busy window after which more is released: with a job, and before it."""
    steps = {task.events.delta_min(job) for task in ready.tasks for job in range(1, task.events.eta_plus(window) + 1)}
    return {each for step in steps for each in (step, step + 1) if each < window}


def _latest_after(after: Time, index: int, ready: ReadySet, known: Mapping[str, Time]) -> Time:
    """The response time of a job that is released so long after the begin of the busy window."""
    task, limit = ready.tasks[index], known[ready.tasks[index].name]
    earlier = 1 + task.demand.max_demand(task.events.eta_plus(after + 1) - 1)
    most = [other.events.eta_plus(after) + ready.most_calls(number, index, known) for number, other in enumerate(ready.tasks)]

    def before(start: Time) -> Time:
        calls = ((other, min(other.events.eta_plus(start), count)) for other, count in zip(ready.tasks, most, strict=True))
        return earlier + sum(other.demand.max_demand(count) for other, count in calls if other is not task)

    start = 1
    while start <= after + limit:
        reached = ready.supply.time_for(before(start))
        if reached <= start:
            return ready.supply.time_for(before(start) + task.demand.worst - 1) - after
        start = reached
    return limit
