"""End-to-end latencies by immediate forward and backward job chains.

M. Günzel, K.-H. Chen, N. Ueter, G. von der Brüggen, M. Dürr and J.-J. Chen, "Timing analysis of asynchronized distributed cause-effect
chains", RTAS 2021 (augmented job chains). Where execution times vary, the earliest reads and the latest writes give bounds; a writer
that preempts its reader on the same core is not interrupted by it: M. Günzel and others, "Compositional timing
analysis of asynchronized distributed cause-effect chains", ACM Transactions on Embedded Computing Systems 22(4), 2023.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import lcm
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from amalthea_uros._internal.records import dataclass, fields, replace
from amalthea_uros.analyze.chains.read_write_times import ReadWriteTimes, TimedStage, reach
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers

SOURCE = "Günzel and others 2021, 2023"
#: All job chains of a system together, in all phases, have at most so many jobs; for the others, other methods give bounds.
MAX_JOBS = 10_000_000
TOO_MANY_JOBS = f"the job chains of all chains together, in all phases, would have more than {MAX_JOBS:,} jobs"


@dataclass(slots=True)
class JobBudget:
    """How many jobs the job chains of a system may still have, and how much work single chains took.

    Attributes
    ----------
    work : of the phases of single chains, in jobs
    is_exceeded : whether job chains were not built because of that
    """

    jobs: int = MAX_JOBS
    is_exceeded: bool = False
    work: int = 0

    def build(self, chain: Sequence[ReadWriteTimes], steady_state_start: Time) -> JobChains | None:
        """The job chains of one cycle; None if they would have too many jobs."""
        jobs = job_count(chain, steady_state_start)
        if jobs > self.jobs:
            self.is_exceeded = True
            return None
        self.jobs -= jobs
        return build_job_chains(chain, steady_state_start)


@dataclass(frozen=True, slots=True, kw_only=True)
class Inputs:
    """The jobs of the first task whose data reach the end without being overwritten, after N. Feiertag and others 2008.

    They are those of a cycle and of all jobs before, from the start of the system on.

    Attributes
    ----------
    reads : of each of these jobs
    first_writes, last_writes : of the first and the last output that is based on it
    """

    reads: Numbers
    first_writes: Numbers
    last_writes: Numbers

    @property
    def last_to_first(self) -> Numbers:
        """From an input to the first output based on it."""
        return self.first_writes - self.reads

    @property
    def first_to_last(self) -> Numbers:
        """From just after the previous input, which the first one does not have, to the last output based on this one."""
        return self.last_writes[1:] - self.reads[:-1]


@dataclass(frozen=True, slots=True, kw_only=True)
class JobChainLatencies:
    """The job chains that start at jobs of the first task, and those that end at jobs of the last one.

    Attributes
    ----------
    reads : of the jobs at which forward chains start
    previous_reads : of the jobs before those
    ends : of the forward chains
    starts : reads at which backward chains start
    writes : of the jobs at which they end
    next_writes : of the jobs after those
    """

    reads: Numbers
    previous_reads: Numbers
    ends: Numbers
    starts: Numbers
    writes: Numbers
    next_writes: Numbers

    @property
    def reaction_time(self) -> Time:
        """Maximum reaction time: from an event just after the previous read to the first output caused by it."""
        return int((self.ends - self.previous_reads).max())

    @property
    def first_to_first(self) -> Numbers:
        """From each read to the first output caused by it; the maximum is the maximum reduced reaction time."""
        return self.ends - self.reads

    @property
    def data_age(self) -> Time:
        """Maximum data age: from a read until the output based on it is overwritten."""
        return int((self.next_writes - self.starts).max())

    @property
    def last_to_last(self) -> Numbers:
        """From the read to each output that is based on it; the maximum is the maximum reduced data age."""
        return self.writes - self.starts


@dataclass(frozen=True, slots=True, kw_only=True)
class JobChains(JobChainLatencies):
    """The job chains in one cycle.

    Attributes
    ----------
    inputs : jobs whose data reach the end
    before : those before the cycle: until all tasks have been released, jobs can wait for longer for each other
    possible : outputs before the cycle that use what was there at the start of the system, but, if the times of reads and writes
        are only bounds, may use the output of the first job or of a later one
    """

    inputs: Inputs
    before: JobChainLatencies
    possible: JobChainLatencies

    @property
    def mean_reaction_time(self) -> float:
        """The mean over events that are uniformly distributed in time."""
        waits = (self.reads - self.previous_reads).astype(np.float64)
        return float(((self.ends - self.reads + waits / 2) * waits).sum() / waits.sum())

    def from_start(self, is_exact: bool) -> JobChainLatencies:
        """Those of the cycle and of all jobs before, from the start of the system on.

        Parameters
        ----------
        is_exact : whether jobs read and write at these times, which are no bounds
        """
        every = [self.before, self] if is_exact else [self.before, self.possible, self]
        return JobChainLatencies(**{name: np.concatenate([getattr(each, name) for each in every]) for name in _TIMES})

    def has_times_of(self, other: JobChains) -> bool:
        """Whether all times are those of other job chains."""
        pairs = ((self, other), (self.before, other.before), (self.possible, other.possible), (self.inputs, other.inputs))
        return all(
            np.array_equal(getattr(mine, each.name), getattr(others, each.name))
            for mine, others in pairs
            for each in fields(mine)
            if each.name not in _PARTS
        )


_PARTS = ("inputs", "before", "possible")
_TIMES = tuple(each.name for each in fields(JobChainLatencies))


def job_count(chain: Sequence[ReadWriteTimes], steady_state_start: Time) -> int:
    """The number of jobs of which the job chains of one cycle are made."""
    _, until = _window(chain, steady_state_start)
    return sum(len(task.releases) * (until // task.until) for task in chain)


def _window(chain: Sequence[ReadWriteTimes], steady_state_start: Time) -> tuple[Time, Time]:
    """The start of the cycle, and the end of the jobs that are needed for it."""
    cycle, length = lcm(*(task.cycle for task in chain)), reach(chain)
    # The cycle starts late enough that chains which end in it, or shortly before it, start in the steady state.
    start = steady_state_start + 2 * length
    return start, start + cycle + 2 * length


def build_job_chains(chain: Sequence[ReadWriteTimes], steady_state_start: Time) -> JobChains:
    """The job chains of one cycle.

    Parameters
    ----------
    chain : the tasks of the chain, in order
    steady_state_start : time from which the jobs of all tasks repeat
    """
    start, until = _window(chain, steady_state_start)
    cycle, length = lcm(*(task.cycle for task in chain)), reach(chain)
    whole = [task.extended(until) for task in chain]
    first, last = whole[0], whole[-1]
    begin = _jobs_in(first, start, start + cycle)
    end = _jobs_in(last, start, start + cycle)
    first_jobs, last_jobs = (np.arange(np.searchsorted(task.releases, start), dtype=np.int64) for task in (first, last))
    based = _based_on_a_job(whole, last_jobs)
    own = _latencies(whole, begin, end)
    return JobChains(
        **{name: getattr(own, name) for name in _TIMES},
        inputs=_inputs(whole, np.concatenate([based, _jobs_in(last, start, start + cycle + length)]), start + cycle),
        before=_latencies(whole, first_jobs, based),
        possible=_possible(whole, np.delete(last_jobs, based)),
    )


def _latencies(chain: Sequence[ReadWriteTimes], begin: Numbers, end: Numbers) -> JobChainLatencies:
    """The job chains that start at jobs of the first task, and those that end at jobs of the last one."""
    first, last = chain[0], chain[-1]
    return JobChainLatencies(
        reads=first.reads[begin],
        # No job reads before the first one.
        previous_reads=first.reads[np.maximum(begin - 1, 0)],
        ends=last.writes[forward(chain, begin)],
        starts=first.reads[backward(chain, end)],
        writes=last.writes[end],
        next_writes=last.writes[end + 1],
    )


def _possible(chain: Sequence[ReadWriteTimes], end: Numbers) -> JobChainLatencies:
    """Jobs of the last task as if they used the output of the first job."""
    nothing, last = np.arange(0, dtype=np.int64), chain[-1]
    starts = np.full(len(end), chain[0].reads[0])
    return replace(
        _latencies(chain, nothing, nothing), starts=starts, writes=last.writes[end], next_writes=last.writes[end + 1]
    )


def _inputs(chain: Sequence[ReadWriteTimes], outputs: Numbers, until: Time) -> Inputs:
    """The inputs before a time; some outputs after it belong to them."""
    first, last = chain[0], chain[-1]
    jobs, first_of = np.unique(backward(chain, outputs), return_index=True)
    first_outputs, reads = outputs[first_of], first.reads[jobs]
    here = np.flatnonzero(reads[:-1] < until)
    return Inputs(
        reads=reads[here], first_writes=last.writes[first_outputs[here]], last_writes=last.writes[first_outputs[here + 1] - 1]
    )


def _jobs_in(task: ReadWriteTimes, begin: Time, end: Time) -> Numbers:
    first, last = np.searchsorted(task.releases, (begin, end))
    return np.arange(first, last, dtype=np.int64)


def forward(chain: Sequence[ReadWriteTimes], jobs: Numbers) -> Numbers:
    """The first jobs of the last task that use the outputs of jobs of the first task."""
    for task, reader in pairwise(chain):
        if task.jobs_later is not None:
            # Jobs of one process run in order.
            jobs = np.searchsorted(reader.releases, task.releases[jobs], side="right" if task.jobs_later else "left")
            continue
        # A read sees the data written up to that time, or before it.
        found = np.searchsorted(reader.reads, task.writes[jobs], side="left" if task.is_visible_at_once else "right")
        if task.preempts_reader:
            found = np.minimum(found, np.searchsorted(reader.reads, task.releases[jobs], side="left"))
        jobs = found
    return jobs


def _based_on_a_job(chain: Sequence[ReadWriteTimes], jobs: Numbers) -> Numbers:
    """Those jobs of the last task that use the output of a job of the first one, not what was there at the start of the system."""
    for count in range(2, len(chain) + 1):
        jobs = jobs[backward(chain[-count:], jobs) >= 0]
    return jobs


def backward(chain: Sequence[ReadWriteTimes], jobs: Numbers) -> Numbers:
    """The jobs of the first task whose outputs jobs of the last task use; -1 for what was there at the start of the system."""
    for writer, task in zip(chain[-2::-1], chain[:0:-1], strict=True):
        if writer.jobs_later is not None:
            found = np.searchsorted(writer.releases, task.releases[jobs], side="left" if writer.jobs_later else "right")
        else:
            found = np.searchsorted(writer.writes, task.reads[jobs], side="right" if writer.is_visible_at_once else "left")
            if writer.preempts_reader:
                found = np.maximum(found, np.searchsorted(writer.releases, task.reads[jobs], side="right"))
        jobs = found - 1
    return jobs


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
    if quantity.is_reaction:
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
