"""Latencies by following each job: immediate forward and backward job chains.

M. Günzel, K.-H. Chen, N. Ueter, G. von der Brüggen, M. Dürr and J.-J. Chen, "Timing analysis of asynchronized distributed cause-effect
chains", RTAS 2021 (augmented job chains); with execution times that vary, the same with the earliest reads and the latest writes, and
the rule that a job which comes before its reader on the same core is not interrupted by it: M. Günzel and others, "Compositional timing
analysis of asynchronized distributed cause-effect chains", ACM Transactions on Embedded Computing Systems 22(4), 2023.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import lcm
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.analyze.chains.job_times import ReadWriteTimes, reach
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers

SOURCE = "Günzel and others 2021, 2023"
#: Chains with more jobs are bounded otherwise.
MAX_JOBS = 10_000_000


@dataclass(frozen=True, slots=True, kw_only=True)
class Inputs:
    """The jobs of the first step whose data are not overwritten on the way, after N. Feiertag and others 2008.

    Attributes
    ----------
    reads, reads_before : of these jobs, and of those of them before each
    first_writes, last_writes : of the first and the last output that is based on each
    """

    reads: Numbers
    reads_before: Numbers
    first_writes: Numbers
    last_writes: Numbers

    @property
    def last_to_first(self) -> Numbers:
        """From an input to the first output based on it."""
        return self.first_writes - self.reads

    @property
    def first_to_last(self) -> Numbers:
        """From just behind the input before to the last output based on this one."""
        return self.last_writes - self.reads_before


@dataclass(frozen=True, slots=True, kw_only=True)
class JobChains:
    """The job chains that start at the jobs of the first step, and those that end at the jobs of the last one, in one cycle.

    Attributes
    ----------
    reads : of the jobs at which forward chains start
    reads_before : of the jobs before those
    ends : of the forward chains
    starts : reads at which backward chains start
    writes : of the jobs at which they end
    writes_behind : of the jobs behind those
    inputs : reads of which the data reach the end
    """

    reads: Numbers
    reads_before: Numbers
    ends: Numbers
    starts: Numbers
    writes: Numbers
    writes_behind: Numbers
    inputs: Inputs

    @property
    def reaction_time(self) -> Time:
        """Maximum reaction time: an event just behind the read before, to the first output that it has caused."""
        return int((self.ends - self.reads_before).max())

    @property
    def mean_reaction_time(self) -> float:
        """The mean over events that come at any moment alike."""
        waits = (self.reads - self.reads_before).astype(np.float64)
        return float(((self.ends - self.reads + waits / 2) * waits).sum() / waits.sum())

    @property
    def first_to_first(self) -> Numbers:
        """From each read to the first output that it has caused; the greatest is the maximum reduced reaction time."""
        return self.ends - self.reads

    @property
    def data_age(self) -> Time:
        """Maximum data age: from the read to the moment at which the output is overwritten."""
        return int((self.writes_behind - self.starts).max())

    @property
    def last_to_last(self) -> Numbers:
        """From the read to each output that is based on it; the greatest is the maximum reduced data age."""
        return self.writes - self.starts


def build_job_chains(tracks: Sequence[ReadWriteTimes], steady_state_start: Time) -> JobChains | None:
    """Follow all jobs of one cycle; None if that is too much work.

    Parameters
    ----------
    tracks : of the steps of the chain, in order
    steady_state_start : the time behind which all steps repeat
    """
    cycle, length = lcm(*(track.cycle for track in tracks)), reach(tracks)
    # A cycle so far after the start of the steady state that chains which end in it, or a little before it, start after that.
    start = steady_state_start + 2 * length
    until = start + cycle + 2 * length
    if sum(len(track.releases) * (until // track.until) for track in tracks) > MAX_JOBS:
        return None
    whole = [track.extended(until) for track in tracks]
    first, last = whole[0], whole[-1]
    begin = _jobs_in(first, start, start + cycle)
    end = _jobs_in(last, start, start + cycle)
    return JobChains(
        reads=first.reads[begin],
        reads_before=first.reads[begin - 1],
        ends=last.writes[forward(whole, begin)],
        starts=first.reads[backward(whole, end)],
        writes=last.writes[end],
        writes_behind=last.writes[end + 1],
        inputs=_inputs(whole, start, cycle, length),
    )


def _inputs(tracks: Sequence[ReadWriteTimes], start: Time, cycle: Time, length: Time) -> Inputs:
    first, last = tracks[0], tracks[-1]
    outputs = _jobs_in(last, start - length, start + cycle + length)
    jobs, first_of = np.unique(backward(tracks, outputs), return_index=True)
    first_outputs = outputs[first_of]
    reads = first.reads[jobs]
    # Without the ones at both ends, of which not all outputs are there.
    here = np.flatnonzero((reads[1:-1] >= start) & (reads[1:-1] < start + cycle)) + 1
    return Inputs(
        reads=reads[here],
        reads_before=reads[here - 1],
        first_writes=last.writes[first_outputs[here]],
        last_writes=last.writes[first_outputs[here + 1] - 1],
    )


def _jobs_in(track: ReadWriteTimes, begin: Time, end: Time) -> Numbers:
    first, last = np.searchsorted(track.releases, (begin, end))
    return np.arange(first, last, dtype=np.int64)


def forward(tracks: Sequence[ReadWriteTimes], jobs: Numbers) -> Numbers:
    """The jobs of the last step that are the first to use what jobs of the first step wrote."""
    for track, reader in pairwise(tracks):
        # A read sees what has been written at that moment.
        found = np.searchsorted(reader.reads, track.writes[jobs], side="left")
        if track.preempts_reader:
            found = np.minimum(found, np.searchsorted(reader.reads, track.releases[jobs], side="left"))
        jobs = found
    return jobs


def backward(tracks: Sequence[ReadWriteTimes], jobs: Numbers) -> Numbers:
    """The jobs of the first step that wrote what jobs of the last one use."""
    for writer, track in zip(tracks[-2::-1], tracks[:0:-1], strict=True):
        found = np.searchsorted(writer.writes, track.reads[jobs], side="right")
        if writer.preempts_reader:
            found = np.maximum(found, np.searchsorted(writer.releases, track.reads[jobs], side="right"))
        jobs = found - 1
    return jobs
