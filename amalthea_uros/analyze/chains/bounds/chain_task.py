"""A task of a chain as the bounds see it: without a schedule, only activation, response time and priority."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import lcm
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.timing.basics.limits import LIMIT
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers

#: Bounds that examine all jobs of a hyperperiod are not computed for more jobs.
MAX_JOBS = 10_000_000


@dataclass(frozen=True, slots=True, kw_only=True)
class ChainTask:
    """A task in a chain.

    Attributes
    ----------
    period : maximum time between two releases, if there is one (`is_regular`)
    response : worst-case response time
    offset : of the first release; None if releases are unknown
    first_release : the latest time of it, also if later ones are unknown
    preempts_reader : whether its jobs preempt those of the next task on the same core
    """

    name: str = ""
    period: Time
    response: Time
    is_regular: bool = True
    offset: Time | None = 0
    first_release: Time = 0
    preempts_reader: bool = False


def first_releases(tasks: Sequence[ChainTask]) -> Numbers | None:
    """The releases of the first task in one hyperperiod of the chain; None if they are unknown or too many."""
    if any(task.offset is None for task in tasks):
        return None
    cycle = lcm(*(task.period for task in tasks))
    count = cycle // tasks[0].period
    steady_state_start = max(task.offset or 0 for task in tasks)
    if count * len(tasks) > MAX_JOBS or steady_state_start + 2 * cycle > LIMIT:
        return None
    offset = tasks[0].offset or 0
    lead = -(-(steady_state_start - offset) // tasks[0].period)
    releases: Numbers = offset + tasks[0].period * (lead + np.arange(count, dtype=np.int64))
    return releases
