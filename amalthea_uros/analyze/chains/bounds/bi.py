"""A bound of the data age of periodic tasks with the same offset, from each task to the next.

R. Bi, X. Liu, J. Ren, P. Wang, H. Lv and G. Tan, "Efficient maximum data age analysis for cause-effect chains in automotive
systems", DAC 2022: the releases of two periodic tasks are multiples of the greatest common divisor of their periods apart.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import gcd

from amalthea_uros.analyze.chains.bounds.chain_task import ChainTask
from amalthea_uros.units import Time

SOURCE = "Bi and others 2022"


def reduced_data_age(tasks: Sequence[ChainTask]) -> Time:
    """A bound of the maximum reduced data age of tasks that are released together."""
    return tasks[-1].response + sum(_between(task, reader) for task, reader in pairwise(tasks))


def _between(task: ChainTask, reader: ChainTask) -> Time:
    grid = gcd(task.period, reader.period)
    if task.preempts_reader:
        return task.period - grid
    return task.response + task.period - (task.response % grid or grid)
