"""The inner loops of busy windows and schedules on integers; compiled if numba is installed.

Only the first `count` rows of an array are used, so that all priorities share one array.
"""

from __future__ import annotations

from heapq import heapify, heappop, heappush, heapreplace
from operator import attrgetter
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from amalthea_uros._internal.compiled import compiled
from amalthea_uros.timing.basics.time_base import LIMIT

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Numbers = NDArray[np.int64]

#: Integers: a list if interpreted, an array if compiled.
Whole: TypeAlias = Any

#: A busy window that still grows after so many steps is considered unbounded.
MAX_STEPS = 100_000


@compiled(cost=20)
def demand_in(
    window: int, periods: Numbers, jitters: Numbers, distances: Numbers, demands: Numbers, count: int, limited: bool
) -> int:
    """The demand that is activated in a window; minimum distances are ignored unless `limited`."""
    events = (window + jitters[:count] + periods[:count] - 1) // periods[:count]
    if limited:
        nearby = (window + distances[:count] - 1) // np.maximum(distances[:count], 1)
        events = np.where(distances[:count] > 0, np.minimum(events, nearby), events)
    return int((events * demands[:count]).sum())


@compiled(cost=20)
def least_fixed_point(
    window: int,
    fixed: int,
    periods: Numbers,
    jitters: Numbers,
    distances: Numbers,
    demands: Numbers,
    count: int,
    limited: bool,
) -> int:
    """The shortest window that serves its own demand, at least `window`; more than LIMIT if there is none."""
    for _ in range(MAX_STEPS):
        events = (window + jitters[:count] + periods[:count] - 1) // periods[:count]
        if limited:
            nearby = (window + distances[:count] - 1) // np.maximum(distances[:count], 1)
            events = np.where(distances[:count] > 0, np.minimum(events, nearby), events)
        demand = fixed + int((events * demands[:count]).sum())
        if demand <= window:
            return window
        if demand > LIMIT:
            return demand
        window = demand
    return LIMIT + 1


@compiled(cost=20)
def greatest_fixed_point(own: int, start: int, periods: Numbers, demands: Numbers, count: int) -> int:
    """The greatest fixed point, at most `start`, of the best-case response time."""
    response = start
    while True:
        unavoidable = np.maximum((response + periods[:count] - 1) // periods[:count] - 1, 0)
        reached = own + int((unavoidable * demands[:count]).sum())
        if reached >= response:
            return response
        response = reached


@compiled(cost=0)
def dispatch(
    periods: Whole,
    offsets: Whole,
    ranks: Whole,
    firsts: Whole,
    tables: Whole,
    leads: Whole,
    cycles: Whole,
    demands: Whole,
    recorded: Whole,
    until: int,
    begins: Whole,
    ends: Whole,
) -> list[tuple[int, int, int]]:
    """Schedule jobs by fixed priority with preemption.

    Fills in when each job begins and ends, and returns the execution slices of the recorded tasks.

    Parameters
    ----------
    ranks : lower ones are served first; equal ones in order of release
    firsts : the number of the first job of each task; its jobs follow
    tables, leads, cycles : first index of a task in `demands`, number of jobs before its demands repeat, and length of a cycle
    demands : of the jobs of all tasks
    recorded : whether the execution slices of a task are returned
    until : jobs released before it are served to their end
    begins, ends : results; initially -1

    Returns
    -------
    list of (job, begin, end)
    """
    upcoming = [(offsets[number], ranks[number], number, 0) for number in range(len(periods))]
    heapify(upcoming)
    # An empty list has no type when compiled.
    ready = [(0, 0, 0, 0, 0)]
    ready.pop()
    slices = [(0, 0, 0)]
    slices.pop()
    now = 0
    pending = 0
    while pending > 0 or upcoming[0][0] < until:
        if len(ready) == 0:
            now = max(now, upcoming[0][0])
        while upcoming[0][0] <= now:
            release, rank, number, index = upcoming[0]
            heapreplace(upcoming, (release + periods[number], rank, number, index + 1))
            lead = leads[number]
            at = index if index < lead else lead + (index - lead) % cycles[number]
            job = -1
            if release < until:
                job = firsts[number] + index
                pending += 1
            heappush(ready, (rank, release, number, demands[tables[number] + at], job))
        rank, release, number, left, job = ready[0]
        if job >= 0 and begins[job] < 0:
            begins[job] = now
        end = min(now + left, upcoming[0][0])
        if now + left <= upcoming[0][0]:
            heappop(ready)
            if job >= 0:
                ends[job] = end
                pending -= 1
        else:
            # The order depends on rank, release and number only, so that the heap stays valid.
            heapreplace(ready, (rank, release, number, left - (end - now), job))
        if job >= 0 and recorded[number]:
            if len(slices) > 0 and slices[-1][0] == job and slices[-1][2] == now:
                slices[-1] = (job, slices[-1][1], end)
            else:
                slices.append((job, now, end))
        now = end
    return slices


LOOPS = (demand_in, least_fixed_point, greatest_fixed_point, dispatch)


def report_machine_code() -> None:
    """Log why there is no machine code, if there is none; when something is compiled, that is logged then."""
    if not any(loop.is_compiled for loop in LOOPS):
        max((loop.effort for loop in LOOPS), key=attrgetter("spent")).report(is_used=False)
