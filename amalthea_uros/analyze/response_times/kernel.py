"""The loops of busy windows and of schedules, over whole numbers; compiled where that is possible.

Of the rows of an array only the first `count` are used, so that those of all priorities share one array.
"""

from __future__ import annotations

from heapq import heapify, heappop, heappush, heapreplace
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from amalthea_uros._internal.compiled import compiled
from amalthea_uros.timing.limits import LIMIT

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Numbers = NDArray[np.int64]

#: Whole numbers: a list as Python, an array as machine code.
Whole: TypeAlias = Any

#: A busy window that is still growing after so many steps is taken to have no end.
MAX_STEPS = 100_000


@compiled(cost=20)
def demand_in(
    window: int, periods: Numbers, jitters: Numbers, distances: Numbers, costs: Numbers, count: int, limited: bool
) -> int:
    """The demand that arrives in a window; without least distances where `limited` is false."""
    arrivals = (window + jitters[:count] + periods[:count] - 1) // periods[:count]
    if limited:
        near = (window + distances[:count] - 1) // np.maximum(distances[:count], 1)
        arrivals = np.where(distances[:count] > 0, np.minimum(arrivals, near), arrivals)
    return int((arrivals * costs[:count]).sum())


@compiled(cost=20)
def fixed_point(
    window: int,
    fixed: int,
    periods: Numbers,
    jitters: Numbers,
    distances: Numbers,
    costs: Numbers,
    count: int,
    limited: bool,
) -> int:
    """The least window that holds its own demand, from a lower bound on; more than LIMIT if there is none below it."""
    for _ in range(MAX_STEPS):
        arrivals = (window + jitters[:count] + periods[:count] - 1) // periods[:count]
        if limited:
            near = (window + distances[:count] - 1) // np.maximum(distances[:count], 1)
            arrivals = np.where(distances[:count] > 0, np.minimum(arrivals, near), arrivals)
        demand = fixed + int((arrivals * costs[:count]).sum())
        if demand <= window:
            return window
        if demand > LIMIT:
            return demand
        window = demand
    return LIMIT + 1


@compiled(cost=20)
def least_response(own: int, start: int, periods: Numbers, costs: Numbers, count: int) -> int:
    """The greatest fixed point below a start of what a job waits for at least."""
    response = start
    while True:
        avoidable = np.maximum((response + periods[:count] - 1) // periods[:count] - 1, 0)
        reached = own + int((avoidable * costs[:count]).sum())
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
    costs: Whole,
    watched: Whole,
    until: int,
    begins: Whole,
    ends: Whole,
) -> list[tuple[int, int, int]]:
    """Serve jobs by priority with preemption; fills in when each job begins and ends, and returns the pieces of those that are watched.

    Parameters
    ----------
    ranks : lower ones are served first, equal ones in the order of release
    firsts : the number of the first job of each task; its jobs follow
    tables, leads, cycles, costs : where the costs of the jobs of a task stand, how many come before they repeat, and after how many
    until : jobs that are released before it are served to their end
    begins, ends : -1 at first

    Returns
    -------
    list of (job, begin, end)
    """
    upcoming = [(offsets[number], ranks[number], number, 0) for number in range(len(periods))]
    heapify(upcoming)
    # A list has to hold something once, to have a type.
    ready = [(0, 0, 0, 0, 0)]
    ready.pop()
    pieces = [(0, 0, 0)]
    pieces.pop()
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
            heappush(ready, (rank, release, number, costs[tables[number] + at], job))
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
            # Rank, release and number decide about the order; what is left does not.
            heapreplace(ready, (rank, release, number, left - (end - now), job))
        if job >= 0 and watched[number]:
            if len(pieces) > 0 and pieces[-1][0] == job and pieces[-1][2] == now:
                pieces[-1] = (job, pieces[-1][1], end)
            else:
                pieces.append((job, now, end))
        now = end
    return pieces
