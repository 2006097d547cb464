"""What the bounds know of a step of a chain: no schedule, but how often it comes and how long it takes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import lcm
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.timing.limits import LIMIT
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers

#: Bounds that go through all jobs of a hyperperiod give up beyond.
MAX_JOBS = 10_000_000


@dataclass(frozen=True, slots=True, kw_only=True)
class ChainTask:
    """A task in a chain.

    Attributes
    ----------
    period : the longest time between two releases, if `is_regular`: there is such a time
    response : worst-case response time
    offset : of the first release; None if releases are not known
    preempts_reader : whether its jobs come before those of the next step on the same core
    """

    name: str = ""
    period: Time
    response: Time
    is_regular: bool = True
    offset: Time | None = 0
    preempts_reader: bool = False


def first_releases(steps: Sequence[ChainTask]) -> Numbers | None:
    """The releases of the first step in one hyperperiod of the chain; None if they are not known, or too many."""
    if any(step.offset is None for step in steps):
        return None
    cycle = lcm(*(step.period for step in steps))
    count = cycle // steps[0].period
    steady_state_start = max(step.offset or 0 for step in steps)
    if count * len(steps) > MAX_JOBS or steady_state_start + 2 * cycle > LIMIT:
        return None
    offset = steps[0].offset or 0
    lead = -(-(steady_state_start - offset) // steps[0].period)
    releases: Numbers = offset + steps[0].period * (lead + np.arange(count, dtype=np.int64))
    return releases
