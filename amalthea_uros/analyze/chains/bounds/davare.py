"""A bound of the maximum reaction time from periods and response times alone.

A. Davare, Q. Zhu, M. Di Natale, C. Pinello, S. Kanajan and A. Sangiovanni-Vincentelli, "Period optimization for hard real-time
distributed automotive systems", DAC 2007: at each task a period of waiting and a response time. No common clock is required.
"""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.analyze.chains.bounds.chain_task import ChainTask
from amalthea_uros.units import Time

SOURCE = "Davare and others 2007"


def reaction_time(tasks: Sequence[ChainTask]) -> Time:
    """A bound of the maximum reaction time."""
    return sum(task.period + task.response for task in tasks)
