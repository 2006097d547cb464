"""A bound of the reaction time under logical execution time (LET).

A. Hamann, D. Dasari, S. Kramer, M. Pressler and F. Wurst, "Communication centric design in complex automotive embedded systems",
ECRTS 2017: at each task a period of waiting, and a period until the output becomes visible.
"""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.analyze.chains.bounds.chain_task import ChainTask
from amalthea_uros.units import Time

SOURCE = "Hamann and others 2017"


def reaction_time(tasks: Sequence[ChainTask]) -> Time:
    """A bound of the maximum reaction time."""
    return sum(2 * task.period for task in tasks)
