"""Bounds of the data age of periodic tasks with known releases, by reachability of jobs.

M. Becker, D. Dasari, S. Mubeen, M. Behnam and T. Nolte, "End-to-end timing analysis of cause-effect chains in automotive embedded
systems", Journal of Systems Architecture 80, 2017: a job can read until its latest start, and the output of a job can be read until the
next one has ended; the last reachable job of each task gives the longest path.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from amalthea_uros.analyze.chains.bounds.chain_task import ChainTask, first_releases
from amalthea_uros.units import Time

SOURCE = "Becker and others 2017"


def reduced_data_age(tasks: Sequence[ChainTask]) -> Time | None:
    """A bound of the maximum reduced data age; None if releases are unknown or too many."""
    first = first_releases(tasks)
    if first is None:
        return None
    release = first
    for task, reader in pairwise(tasks):
        overwritten = release + task.period + task.response - (reader.offset or 0)
        release = (reader.offset or 0) + (-(-overwritten // reader.period) - 1) * reader.period
    return int((release - first).max()) + tasks[-1].response
