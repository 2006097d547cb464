"""The schedule of tasks with known releases under fixed priorities with preemption, job by job."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import accumulate
from math import lcm
from typing import TYPE_CHECKING, Any

import numpy as np

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.response_times.kernel import Whole, dispatch
from amalthea_uros.timing.basics.time_base import LIMIT
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers

#: Schedules with more jobs are not computed; busy windows give bounds.
MAX_JOBS = 300_000


@dataclass(frozen=True, slots=True, kw_only=True)
class PeriodicTask:
    """A task released at offset + k * period; higher priorities are served first."""

    name: str
    period: Time
    offset: Time
    demand: MultiframeDemand
    priority: int


@dataclass(frozen=True, slots=True)
class Jobs:
    """When the jobs of a task are released, begin and end, and when they execute, if that is recorded.

    Attributes
    ----------
    execution_slices : rows of (number of the job, begin, end)
    """

    releases: Numbers
    begins: Numbers
    ends: Numbers
    execution_slices: Numbers


def schedule(
    tasks: Sequence[PeriodicTask],
    until: Time,
    demand_of: Callable[[MultiframeDemand, int], Time],
    recorded: Sequence[bool] | None = None,
) -> list[Jobs]:
    """The jobs of each task that are released before a time.

    Parameters
    ----------
    demand_of : demand of the n-th job, counted from 1
    recorded : for each task, whether its execution slices are needed; None: for none
    """
    counts = [max(0, -(-(until - task.offset) // task.period)) for task in tasks]
    firsts = list(accumulate(counts, initial=0))
    cycles = [demand_cycle(task.demand) for task in tasks]
    demands = [demand_table(task.demand, demand_of) for task in tasks]
    leads = [len(row) - length for row, length in zip(demands, cycles, strict=True)]
    tables = list(accumulate(map(len, demands), initial=0))
    periods, offsets = [task.period for task in tasks], [task.offset for task in tasks]
    ranks, is_recorded = [-task.priority for task in tasks], list(recorded or [False] * len(tasks))
    # About 3 us for each job if interpreted.
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
        form([demand for row in demands for demand in row]),
        form(is_recorded),
        until,
        begins,
        ends,
    )
    begins, ends = np.asarray(begins, dtype=np.int64), np.asarray(ends, dtype=np.int64)
    slices = np.array(found, dtype=np.int64).reshape(-1, 3)
    result = []
    for number, task in enumerate(tasks):
        first, last = firsts[number], firsts[number + 1]
        releases = task.offset + task.period * np.arange(last - first, dtype=np.int64)
        own = slices[(slices[:, 0] >= first) & (slices[:, 0] < last)] - (first, 0, 0) if is_recorded[number] else slices[:0]
        result.append(Jobs(releases, begins[first:last], ends[first:last], own))
    return result


@lru_cache(maxsize=1024)
def demand_table(demand: MultiframeDemand, demand_of: Callable[[MultiframeDemand, int], Time]) -> Sequence[Time]:
    """The demands of the first jobs: those before the cycle, then one cycle."""
    return tuple(demand_of(demand, index + 1) for index in range(demand_lead(demand) + demand_cycle(demand)))


def demands_of_jobs(demand: MultiframeDemand, count: int, demand_of: Callable[[MultiframeDemand, int], Time]) -> Numbers:
    """The demands of the first jobs."""
    table, cycle = demand_table(demand, demand_of), demand_cycle(demand)
    index, lead = np.arange(count), len(table) - cycle
    found: Numbers = np.array(table, dtype=np.int64)[np.where(index < lead, index, lead + (index - lead) % cycle)]
    return found


def demand_lead(demand: MultiframeDemand) -> int:
    """Number of jobs before the demands repeat, because a counter starts later than its prescaler makes it repeat."""
    return max((max(0, frame.offset - frame.prescaler) for frame in demand.frames), default=0)


def demand_cycle(demand: MultiframeDemand) -> int:
    """Number of jobs after which the demands repeat."""
    return lcm(*(frame.prescaler for frame in demand.frames))


def hyperperiod(tasks: Sequence[PeriodicTask]) -> Time:
    """The time after which releases and demands repeat."""
    return lcm(*(task.period * demand_cycle(task.demand) for task in tasks))


def steady_state_start(tasks: Sequence[PeriodicTask]) -> Time:
    """The time at which all tasks have been released and all counters have started; the schedule repeats a hyperperiod later."""
    return max((task.offset + demand_lead(task.demand) * task.period for task in tasks), default=0)


def fits(tasks: Sequence[PeriodicTask], until: Time) -> bool:
    """Whether a schedule up to a time is short enough to compute, and the core is not overloaded.

    Not where it is unknown in which jobs something is executed, although not in all: in a schedule each job would execute it.
    """
    if any(frame.prescaler > 1 and not frame.is_certain for task in tasks for frame in task.demand.frames):
        return False
    if until > LIMIT or sum(until // task.period + 1 for task in tasks) > MAX_JOBS:
        return False
    return load(tasks) <= 1


def load(tasks: Sequence[PeriodicTask]) -> Fraction:
    """The part of the time for which tasks execute in the long run, in the worst case."""
    cycle = hyperperiod(tasks)
    frames = ((frame, task.period * frame.prescaler) for task in tasks for frame in task.demand.frames)
    return Fraction(sum(frame.worst * (cycle // interval) for frame, interval in frames), cycle)
