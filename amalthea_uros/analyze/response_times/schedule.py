"""The schedule of a processor under fixed priorities with preemption, job by job.

For tasks whose releases are known the schedule over two hyperperiods behind the last offset contains every situation (J. Leung and
J. Whitehead, "On the complexity of fixed-priority scheduling of periodic, real-time tasks", Performance Evaluation 2, 1982). With fixed
releases and without blocking a job never ends later because another one executes for a shorter time, so that the schedule of all worst
cases holds the worst response times, and that of all best cases the best ones.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import accumulate
from math import lcm
from typing import TYPE_CHECKING, Any

import numpy as np

from amalthea_uros.analyze.response_times.kernel import Whole, dispatch
from amalthea_uros.analyze.results import Claim, Response
from amalthea_uros.timing.limits import LIMIT
from amalthea_uros.timing.multiframe import MultiframeDemand
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers

METHOD = "schedule over the hyperperiod, fixed priorities, preemptive"
SOURCE = "Leung, Whitehead 1982"
#: Longer schedules are not worth their time; a bound serves.
MAX_JOBS = 300_000


@dataclass(frozen=True, slots=True, kw_only=True)
class PeriodicTask:
    """A task whose releases are known: offset + k * period; higher numbers are served first."""

    name: str
    period: Time
    offset: Time
    cost: MultiframeDemand
    priority: int


@dataclass(frozen=True, slots=True)
class Jobs:
    """The jobs of a task in order: when each is released, begins and ends, and in which pieces, where those were asked for.

    Attributes
    ----------
    pieces : rows of (number of the job, begin, end)
    """

    releases: Numbers
    begins: Numbers
    ends: Numbers
    execution_slices: Numbers


def schedule(
    tasks: Sequence[PeriodicTask],
    until: Time,
    cost_of: Callable[[MultiframeDemand, int], Time],
    watched: Sequence[bool] | None = None,
) -> list[Jobs]:
    """The jobs of each task that are released before a time, all of them served to their ends.

    Parameters
    ----------
    cost_of : what the n-th job (from 1) of a task executes
    watched : of which tasks the pieces are wanted; None: of none
    """
    counts = [max(0, -(-(until - task.offset) // task.period)) for task in tasks]
    firsts = list(accumulate(counts, initial=0))
    cycles = [cycle(task.cost) for task in tasks]
    costs = [table(task.cost, cost_of) for task in tasks]
    leads = [len(row) - length for row, length in zip(costs, cycles, strict=True)]
    tables = list(accumulate(map(len, costs), initial=0))
    periods, offsets = [task.period for task in tasks], [task.offset for task in tasks]
    ranks, watch = [-task.priority for task in tasks], list(watched or [False] * len(tasks))
    # About 3 us for each job as Python.
    dispatch.expect(3 * firsts[-1])
    form: Callable[[Any], Whole] = np.array if dispatch.is_compiled else list
    begins, ends = form([-1] * firsts[-1]), form([-1] * firsts[-1])
    found = dispatch(
        form(periods),
        form(offsets),
        form(ranks),
        form(firsts[:-1]),
        form(tables[:-1]),
        form(leads),
        form(cycles),
        form([cost for row in costs for cost in row]),
        form(watch),
        until,
        begins,
        ends,
    )
    begins, ends = np.asarray(begins, dtype=np.int64), np.asarray(ends, dtype=np.int64)
    pieces = np.array(found, dtype=np.int64).reshape(-1, 3)
    result = []
    for number, task in enumerate(tasks):
        first, last = firsts[number], firsts[number + 1]
        releases = task.offset + task.period * np.arange(last - first, dtype=np.int64)
        own = pieces[(pieces[:, 0] >= first) & (pieces[:, 0] < last)] - (first, 0, 0) if watch[number] else pieces[:0]
        result.append(Jobs(releases, begins[first:last], ends[first:last], own))
    return result


def table(cost: MultiframeDemand, cost_of: Callable[[MultiframeDemand, int], Time]) -> list[Time]:
    """The costs of the first jobs; the last ones of these repeat, as many as a cycle has."""
    return [cost_of(cost, index + 1) for index in range(_lead(cost) + cycle(cost))]


def _lead(cost: MultiframeDemand) -> int:
    """How many jobs come before the costs repeat: counters with offsets may start late."""
    return max((frame.offset for frame in cost.frames), default=0)


def cycle(cost: MultiframeDemand) -> int:
    """After how many jobs the costs repeat."""
    return lcm(*(frame.prescaler for frame in cost.frames))


def hyperperiod(tasks: Sequence[PeriodicTask]) -> Time:
    """The time after which releases and costs repeat."""
    return lcm(*(task.period * cycle(task.cost) for task in tasks))


def steady_state_start(tasks: Sequence[PeriodicTask]) -> Time:
    """The time behind which all tasks have been released, and all counters have started; a hyperperiod later everything repeats."""
    return max((task.offset + _lead(task.cost) * task.period for task in tasks), default=0)


def fits(tasks: Sequence[PeriodicTask], until: Time) -> bool:
    """Whether a schedule up to a time is worth it, and exists: no more is demanded than served."""
    if until > LIMIT or sum(until // task.period + 1 for task in tasks) > MAX_JOBS:
        return False
    return sum(task.cost.mean_worst / task.period for task in tasks) <= 1


def response_times(tasks: Sequence[PeriodicTask]) -> list[Response] | None:
    """The exact response times; None if the schedule is too long, or the processor overloaded."""
    until = steady_state_start(tasks) + 2 * hyperperiod(tasks)
    if not fits(tasks, until):
        return None
    worst = schedule(tasks, until, MultiframeDemand.worst_of)
    best = schedule(tasks, until, MultiframeDemand.best_of)
    return [_response(task, w, b) for task, w, b in zip(tasks, worst, best, strict=True)]


def _response(task: PeriodicTask, worst: Jobs, best: Jobs) -> Response:
    responses = worst.ends - worst.releases
    at = int(responses.argmax())
    longest, own = int(responses[at]), task.cost.worst_of(at + 1)
    return Response(
        worst=longest,
        best=int((best.ends - best.releases).min()),
        method=METHOD,
        source=SOURCE,
        claim=Claim.EXACT,
        jobs=len(responses),
        window=longest,
        terms={"own": own, "interference": longest - own, "blocking": 0},
    )
