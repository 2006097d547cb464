"""The job chain in which the greatest latency of a chain occurs."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from amalthea_uros.analyze.chains.job_chains import JobBudget, backward, forward
from amalthea_uros.analyze.chains.read_write_times import ReadWriteTimes, TimedStage, reach
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.units import Time

REACTIONS = (LatencyQuantity.MAX_REACTION_TIME, LatencyQuantity.MAX_REDUCED_REACTION_TIME)


class JobPath(NamedTuple):
    """A job of each task, and when the latency begins."""

    times: Sequence[ReadWriteTimes]
    jobs: Sequence[int]
    begin: Time
    overwritten: Time


def worst_path(part: Sequence[TimedStage], quantity: LatencyQuantity) -> JobPath | None:
    """The job chain with the greatest latency; None if there are no job chains."""
    known = [timed.read_write for timed in part if timed.read_write is not None]
    chain = [each.pessimistic for each in known]
    if len(known) < len(part):
        return None
    built = JobBudget().build(chain, max(each.steady_state_start for each in known))
    if built is None:
        return None
    found = built.from_start(is_exact=True)
    until = int(max(found.ends.max(), found.next_writes.max())) + 2 * reach(chain)
    times = [task.extended(until) for task in chain]
    if quantity in REACTIONS:
        begins = found.previous_reads if quantity is LatencyQuantity.MAX_REACTION_TIME else found.reads
        worst = int((found.ends - begins).argmax())
        jobs = [int(np.searchsorted(times[0].reads, found.reads[worst]))]
        for writer, reader in pairwise(times):
            jobs.append(int(forward([writer, reader], np.array(jobs[-1:], dtype=np.int64))[0]))
        return JobPath(times, jobs, int(begins[worst]), 0)
    ends = found.next_writes if quantity is LatencyQuantity.MAX_DATA_AGE else found.writes
    worst = int((ends - found.starts).argmax())
    jobs = [int(np.searchsorted(times[-1].writes, found.writes[worst]))]
    for writer, reader in list(pairwise(times))[::-1]:
        jobs.insert(0, int(backward([writer, reader], np.array(jobs[:1], dtype=np.int64))[0]))
    return JobPath(times, jobs, int(found.starts[worst]), int(ends[worst] - found.writes[worst]))
