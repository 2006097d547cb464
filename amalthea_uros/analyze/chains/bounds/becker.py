"""Bounds of the data age of periodic tasks whose releases are known, by what can reach what.

M. Becker, D. Dasari, S. Mubeen, M. Behnam and T. Nolte, "End-to-end timing analysis of cause-effect chains in automotive embedded
systems", Journal of Systems Architecture 80, 2017: a job can read until it has to start, and what a job wrote can be read until the
next one has ended; the last job that can be reached at each step gives the longest path.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from amalthea_uros.analyze.chains.bounds.chain_task import ChainTask, first_releases
from amalthea_uros.units import Time

SOURCE = "Becker and others 2017"


def reduced_data_age(steps: Sequence[ChainTask]) -> Time | None:
    """A bound of the maximum reduced data age; None if releases are not known, or too many."""
    first = first_releases(steps)
    if first is None:
        return None
    release = first
    for step, reader in pairwise(steps):
        overwritten = release + step.period + step.response - (reader.offset or 0)
        release = (reader.offset or 0) + (-(-overwritten // reader.period) - 1) * reader.period
    return int((release - first).max()) + steps[-1].response
