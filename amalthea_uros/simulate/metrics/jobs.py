"""The distributions of the times of jobs; `timing.job_times` defines the times."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.simulate.metrics.distributions import MetricDistributions
from amalthea_uros.simulate.observations import WITH_HISTOGRAM, CountObservation, MetricObservation
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.timing.observed.job_times import BETWEEN, OWN, JobColumn, own_times, times_between
from amalthea_uros.units import Time

_COUNTS = (JobColumn.PREEMPTIONS, JobColumn.MIGRATIONS)
#: So many jobs at a time stay in the cache of a processor.
_CACHED = 2048
_OWN_HISTOGRAMS = tuple(map(OWN.index, WITH_HISTOGRAM))


@dataclass(slots=True)
class JobMetrics:
    """The metrics of the jobs of a process.

    Attributes
    ----------
    base : time units in a picosecond
    keep : takes the jobs, too
    """

    base: int
    keep: Callable[[Numbers], None] | None = None
    _of_jobs: MetricDistributions = field(init=False)
    _between_jobs: MetricDistributions = field(init=False)
    #: The last job so far, as a column; no column before the first job.
    _last: Numbers = field(init=False)

    def __post_init__(self) -> None:
        self._of_jobs = MetricDistributions(size=len(OWN) + len(_COUNTS), base=self.base, with_histograms=_OWN_HISTOGRAMS)
        self._between_jobs = MetricDistributions(size=len(BETWEEN), base=self.base, with_histograms=())
        self._last = np.empty((len(JobColumn), 0), np.int64)

    def add(self, jobs: Numbers) -> None:
        """Take jobs in: a column for each, in the order of their ends, and a row for each of `JobColumn`."""
        self._of_jobs.add(_own(jobs), jobs[JobColumn.INSTANCE], jobs[JobColumn.ACTIVATION])
        # The first of these jobs follows the last one before them.
        for earlier, later in ((self._last, jobs[:, : self._last.shape[1]]), (jobs[:, :-1], jobs[:, 1:])):
            self._between_jobs.add(times_between(earlier, later), later[JobColumn.INSTANCE], later[JobColumn.ACTIVATION])
        self._last = jobs[:, -1:].copy()
        if self.keep is not None:
            self.keep(jobs)

    @property
    def count(self) -> int:
        """The number of jobs."""
        return self._of_jobs.count

    def total(self, metric: JobMetric) -> int:
        """The sum over all jobs of a time that each of them has, in time units."""
        return self._of_jobs.totals[OWN.index(metric)]

    @property
    def preemptions(self) -> CountObservation:
        """How often jobs were preempted."""
        return self._counted(JobColumn.PREEMPTIONS)

    @property
    def migrations(self) -> CountObservation:
        """How often jobs moved to another core."""
        return self._counted(JobColumn.MIGRATIONS)

    def observations(self, deadline: Time | None) -> Mapping[JobMetric, MetricObservation]:
        """What was observed of each metric; slack time and lateness only if there is a deadline, in picoseconds."""
        found = {metric: self._of_jobs.observation(index) for index, metric in enumerate(OWN)}
        found |= {metric: self._between_jobs.observation(index) for index, metric in enumerate(BETWEEN)}
        response = found[JobMetric.RESPONSE_TIME]
        if deadline is not None and response is not None:
            found[JobMetric.SLACK_TIME] = response.up_to(deadline)
            found[JobMetric.LATENESS] = response.beyond(deadline)
        return {metric: observation for metric in JobMetric if (observation := found.get(metric)) is not None}

    def _counted(self, column: JobColumn) -> CountObservation:
        if self.count == 0:
            return CountObservation(total=0, min=0, max=0)
        index, found = len(OWN) + _COUNTS.index(column), self._of_jobs
        return CountObservation(total=found.totals[index], min=int(found.minima[index]), max=int(found.maxima[index]))


def add_rows(rows: Numbers, processes: Sequence[JobMetrics]) -> None:
    """Take a chunk of rows in, of all processes, in the order of the ends of their jobs."""
    # Numbers of 16 bits are sorted by radix.
    numbers = rows[:, JobColumn.PROCESS].astype(np.int16 if len(processes) <= 2**15 else np.int64)
    order = np.argsort(numbers, kind="stable")
    ends = np.cumsum(np.bincount(rows[:, JobColumn.PROCESS], minlength=len(processes))).tolist()
    for process, first, end in zip(processes, [0, *ends], ends, strict=False):
        for start in range(first, end, _CACHED):
            jobs = np.take(rows, order[start : min(start + _CACHED, end)], axis=0)
            process.add(np.ascontiguousarray(jobs.T))


def _own(jobs: Numbers) -> Numbers:
    """The times of jobs, and how often each was preempted and moved."""
    return np.concatenate([own_times(jobs), jobs[list(_COUNTS)]])
