"""A bound of the data age of periodic tasks whose releases are known, step by step.

R. Bi, X. Liu, J. Ren, P. Wang, H. Lv and G. Tan, "Efficient maximum data age analysis for cause-effect chains in automotive
systems", DAC 2022: releases of two periodic tasks are apart by whole multiples of the greatest common divisor of their periods.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import gcd

from amalthea_uros.analyze.chains.bounds.chain_task import ChainTask
from amalthea_uros.units import Time

SOURCE = "Bi and others 2022"


def reduced_data_age(steps: Sequence[ChainTask]) -> Time:
    """A bound of the maximum reduced data age of tasks that are released together."""
    return steps[-1].response + sum(_between(step, reader) for step, reader in pairwise(steps))


def _between(step: ChainTask, reader: ChainTask) -> Time:
    grid = gcd(step.period, reader.period)
    if step.preempts_reader:
        return step.period - grid
    return step.response + step.period - (step.response % grid or grid)
