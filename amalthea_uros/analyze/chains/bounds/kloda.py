"""A bound of the maximum reaction time of periodic tasks with known releases.

T. Kloda, A. Bertout and Y. Sorel, "Latency analysis for data chains of real-time periodic tasks", ETFA 2018: for each release of
the first task the next release of each further one, after the response time of the previous one unless that preempts it.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from amalthea_uros.analyze.chains.bounds.chain_task import ChainTask, first_releases
from amalthea_uros.units import Time

SOURCE = "Kloda, Bertout, Sorel 2018"


def reaction_time(tasks: Sequence[ChainTask]) -> Time | None:
    """A bound of the maximum reaction time; None if releases are unknown or too many."""
    first = first_releases(tasks)
    if first is None:
        return None
    release = first
    for task, reader in pairwise(tasks):
        written = release + (0 if task.preempts_reader else task.response) - (reader.offset or 0)
        release = (reader.offset or 0) + -(-written // reader.period) * reader.period
    return tasks[0].period + int((release - first).max()) + tasks[-1].response
