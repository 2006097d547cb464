"""A bound of the maximum reaction time of periodic tasks whose releases are known.

T. Kloda, A. Bertout and Y. Sorel, "Latency analysis for data chains of real-time periodic tasks", ETFA 2018: for each release of
the first task the next release of each further one, behind the response time of the one before where that does not come first
anyway.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from amalthea_uros.analyze.chains.bounds.chain_task import ChainTask, first_releases
from amalthea_uros.units import Time

SOURCE = "Kloda, Bertout, Sorel 2018"


def reaction_time(steps: Sequence[ChainTask]) -> Time | None:
    """A bound of the maximum reaction time; None if releases are not known, or too many."""
    first = first_releases(steps)
    if first is None:
        return None
    release = first
    for step, reader in pairwise(steps):
        written = release + (0 if step.preempts_reader else step.response) - (reader.offset or 0)
        release = (reader.offset or 0) + -(-written // reader.period) * reader.period
    return steps[0].period + int((release - first).max()) + steps[-1].response
