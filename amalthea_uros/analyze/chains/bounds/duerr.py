"""Bounds of reaction time and data age of sporadic tasks.

M. Dürr, G. von der Brüggen, K.-H. Chen and J.-J. Chen, "End-to-end timing analysis of sporadic cause-effect chains in distributed
systems", ACM Transactions on Embedded Computing Systems 18(5s), 2019, theorems 5.4 and 5.10. A writer that preempts its reader on
the same core has written before that can read, so that its response time does not count.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from amalthea_uros.analyze.chains.bounds.chain_task import ChainTask
from amalthea_uros.units import Time

SOURCE = "Dürr and others 2019"


def reaction_time(tasks: Sequence[ChainTask]) -> Time:
    """A bound of the maximum reaction time."""
    between = sum(
        max(task.response, reader.period + (0 if task.preempts_reader else task.response)) for task, reader in pairwise(tasks)
    )
    return tasks[0].period + between + tasks[-1].response


def reduced_data_age(tasks: Sequence[ChainTask]) -> Time:
    """A bound of the maximum reduced data age."""
    between = sum(task.period + (0 if task.preempts_reader else task.response) for task in tasks[:-1])
    return between + tasks[-1].response
