"""A bound of the reaction time under logical execution times.

A. Hamann, D. Dasari, S. Kramer, M. Pressler and F. Wurst, "Communication centric design in complex automotive embedded systems",
ECRTS 2017: at each step a period of waiting, and a period until the output is there.
"""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.analyze.chains.bounds.chain_task import ChainTask
from amalthea_uros.units import Time

SOURCE = "Hamann and others 2017"


def reaction_time(steps: Sequence[ChainTask]) -> Time:
    """A bound of the maximum reaction time."""
    return sum(2 * step.period for step in steps)
