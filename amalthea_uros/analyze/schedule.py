"""The schedule of a processor under fixed priorities with preemption, job by job.

For tasks whose releases are known the schedule over two hyperperiods behind the last offset contains every situation (J. Leung and
J. Whitehead, "On the complexity of fixed-priority scheduling of periodic, real-time tasks", Performance Evaluation 2, 1982). With fixed
releases and without blocking a job never ends later because another one executes for a shorter time, so that the schedule of all worst
cases holds the worst response times, and that of all best cases the best ones.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from heapq import heapify, heappop, heappush, heapreplace
from math import lcm

from amalthea_uros.analyze.cost import Cost
from amalthea_uros.analyze.task import Claim, Response
from amalthea_uros.units import Time

METHOD = "schedule over the hyperperiod, fixed priorities, preemptive"
SOURCE = "Leung, Whitehead 1982"
#: Longer schedules are not worth their time; a bound serves.
MOST_JOBS = 300_000


@dataclass(frozen=True, slots=True, kw_only=True)
class Released:
    """A task whose releases are known: offset + k * period; higher numbers are served first."""

    name: str
    period: Time
    offset: Time
    cost: Cost
    priority: int


@dataclass(frozen=True, slots=True)
class Job:
    """A job of a schedule."""

    release: Time
    start: Time
    finish: Time


def schedule(tasks: Sequence[Released], until: Time, cost_of: Callable[[Cost, int], Time]) -> list[list[Job]]:
    """All jobs that are released before a time, by task and in order; jobs of the same priority in the order of release.

    Later releases are there too, as far as they interrupt these jobs.

    Parameters
    ----------
    cost_of : what the n-th job (from 1) of a task executes
    """
    # Releases to come: time, then in the order in which jobs of the same time are served.
    upcoming = [(task.offset, -task.priority, number, 1) for number, task in enumerate(tasks)]
    heapify(upcoming)
    found: list[list[Job]] = [[] for _ in tasks]
    ready: list[list[int]] = []
    now = pending = 0
    while pending or upcoming[0][0] < until:
        if not ready:
            now = max(now, upcoming[0][0])
        while upcoming[0][0] <= now:
            release, rank, number, index = upcoming[0]
            heapreplace(upcoming, (release + tasks[number].period, rank, number, index + 1))
            # Rank, release and number decide; then what is left, and when it started.
            heappush(ready, [rank, release, number, cost_of(tasks[number].cost, index), -1])
            pending += release < until
        job = ready[0]
        _, release, number, left, start = job
        begin = now if start < 0 else start
        if now + left <= upcoming[0][0]:
            now += left
            heappop(ready)
            if release < until:
                pending -= 1
                found[number].append(Job(release, begin, now))
        else:
            # In place: neither what is left nor the start decides the order.
            job[3], job[4] = left - (upcoming[0][0] - now), begin
            now = upcoming[0][0]
    return found


def hyperperiod(tasks: Sequence[Released]) -> Time:
    """The time after which releases and costs repeat."""
    return lcm(*(task.period * lcm(*(part.prescaler for part in task.cost.parts)) for task in tasks))


def response_times(tasks: Sequence[Released]) -> list[Response] | None:
    """The exact response times; None if the schedule is too long, or the processor overloaded."""
    cycle = hyperperiod(tasks)
    # Counters with offsets may start late; behind that everything repeats.
    first = max((_settled(task) for task in tasks), default=0)
    until = first + 2 * cycle
    if sum(until // task.period + 1 for task in tasks) > MOST_JOBS:
        return None
    if sum(task.cost.mean_worst / task.period for task in tasks) > 1:
        return None
    worst = schedule(tasks, until, Cost.worst_of)
    best = schedule(tasks, until, Cost.best_of)
    return [_response(task, w, b) for task, w, b in zip(tasks, worst, best, strict=True)]


def _settled(task: Released) -> Time:
    latest = max((max(part.offset, part.prescaler) for part in task.cost.parts), default=0)
    return task.offset + latest * task.period


def _response(task: Released, worst: Sequence[Job], best: Sequence[Job]) -> Response:
    at = max(range(len(worst)), key=lambda index: worst[index].finish - worst[index].release)
    job = worst[at]
    own = task.cost.worst_of(at + 1)
    return Response(
        worst=job.finish - job.release,
        best=min(job.finish - job.release for job in best),
        method=METHOD,
        source=SOURCE,
        claim=Claim.EXACT,
        jobs=len(worst),
        window=job.finish - job.release,
        terms={"own": own, "interference": job.finish - job.release - own, "blocking": 0},
    )
