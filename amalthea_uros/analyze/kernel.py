"""The loops of busy windows, over arrays of whole numbers; compiled where that is possible.

Of the rows of an array only the first `count` are used, so that those of all priorities share one array.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.compiled import compiled

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Numbers = NDArray[np.int64]

#: A busy window that is still growing after so many steps is taken to have no end.
MOST_STEPS = 100_000
#: Windows beyond it are as good as endless: 13 days in picoseconds, and sums of a few of them still fit into 64 bits.
LIMIT = 2**60


@compiled
def demand_in(
    window: int, periods: Numbers, jitters: Numbers, distances: Numbers, costs: Numbers, count: int, limited: bool
) -> int:
    """The demand that arrives in a window; without least distances where `limited` is false."""
    arrivals = (window + jitters[:count] + periods[:count] - 1) // periods[:count]
    if limited:
        near = (window + distances[:count] - 1) // np.maximum(distances[:count], 1)
        arrivals = np.where(distances[:count] > 0, np.minimum(arrivals, near), arrivals)
    return int((arrivals * costs[:count]).sum())


@compiled
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
    for _ in range(MOST_STEPS):
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


@compiled
def least_response(own: int, start: int, periods: Numbers, costs: Numbers, count: int) -> int:
    """The greatest fixed point below a start of what a job waits for at least."""
    response = start
    while True:
        avoidable = np.maximum((response + periods[:count] - 1) // periods[:count] - 1, 0)
        reached = own + int((avoidable * costs[:count]).sum())
        if reached >= response:
            return response
        response = reached
