"""What a requirement limits, as it was observed."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction

from amalthea_uros.perf.constraints import (
    Bound,
    CountLimit,
    CountMetric,
    JitterLimit,
    Limit,
    LoadLimit,
    LoadMetric,
    RatioLimit,
    RatioMetric,
    TimeLimit,
    TimeMetric,
)
from amalthea_uros.simulate.results import MetricObservation, ProcessObservation, RunnableObservation
from amalthea_uros.timing.jitter import is_deviation_from_period, jitter_of
from amalthea_uros.timing.job_metric import JobMetric
from amalthea_uros.units import Time

_METRICS = {
    TimeMetric.RESPONSE_TIME: JobMetric.RESPONSE_TIME,
    TimeMetric.NET_EXECUTION_TIME: JobMetric.NET_EXECUTION_TIME,
    TimeMetric.GROSS_EXECUTION_TIME: JobMetric.GROSS_EXECUTION_TIME,
    TimeMetric.RUNNING_TIME: JobMetric.RUNNING_TIME,
    # On one core: it is the running time unless jobs migrate.
    TimeMetric.CORE_EXECUTION_TIME: JobMetric.RUNNING_TIME,
    TimeMetric.READY_TIME: JobMetric.READY_TIME,
    TimeMetric.WAITING_TIME: JobMetric.WAITING_TIME,
    TimeMetric.POLLING_TIME: JobMetric.POLLING_TIME,
    TimeMetric.PARKING_TIME: JobMetric.PARKING_TIME,
    TimeMetric.START_DELAY: JobMetric.INITIAL_PENDING_TIME,
    TimeMetric.LATENESS: JobMetric.LATENESS,
    TimeMetric.ACTIVATE_TO_ACTIVATE: JobMetric.ACTIVATE_TO_ACTIVATE,
    TimeMetric.START_TO_START: JobMetric.START_TO_START,
    TimeMetric.END_TO_END: JobMetric.END_TO_END,
    TimeMetric.END_TO_START: JobMetric.END_TO_START,
}
_SHARES = {
    LoadMetric.RUNNING: JobMetric.RUNNING_TIME,
    LoadMetric.READY: JobMetric.READY_TIME,
    LoadMetric.WAITING: JobMetric.WAITING_TIME,
    LoadMetric.PARKING: JobMetric.PARKING_TIME,
    LoadMetric.POLLING: JobMetric.POLLING_TIME,
}
_RATIOS = {
    RatioMetric.NORMALIZED_RESPONSE_TIME: JobMetric.RESPONSE_TIME,
    RatioMetric.NORMALIZED_LATENESS: JobMetric.LATENESS,
}


@dataclass(frozen=True, slots=True, kw_only=True)
class LimitedValues:
    """The observed values of something.

    Attributes
    ----------
    low, high : the smallest and the greatest one; None if there is none, for the `reason`
    pending : what has already passed of one that had not ended at the end of the run
    is_complete : whether all values are known
    reason : why values are missing
    low_at, high_at : when the smallest and the greatest one were observed, in picoseconds; None if that is not one time
    """

    low: Fraction | None = None
    high: Fraction | None = None
    pending: Fraction = Fraction(0)
    is_complete: bool = True
    reason: str = ""
    low_at: Fraction | None = None
    high_at: Fraction | None = None

    @classmethod
    def of(cls, found: MetricObservation | None, reason: str) -> LimitedValues:
        """Those of a time, or the reason why there is none."""
        if found is None:
            return cls(reason=reason)
        return cls(low=found.min, high=found.max, low_at=found.at_min.time, high_at=found.at_max.time)

    @classmethod
    def only(cls, value: Fraction | int) -> LimitedValues:
        """Those of something that has one value in a run."""
        return cls(low=Fraction(value), high=Fraction(value))

    def jitter(self, period: Time | None = None) -> LimitedValues:
        """The jitter of the values, as `timing.jitter.jitter_of` defines it."""
        if self.low is None or self.high is None:
            return replace(self, pending=Fraction(0))
        found, late = jitter_of(self.low, self.high, period), [at for at in (self.low_at, self.high_at) if at is not None]
        # A value that is pending exceeds the least one already.
        pending = max(Fraction(0), self.pending - self.low)
        return replace(self, low=found, high=found, pending=pending, high_at=max(late, default=None))


@dataclass(frozen=True, slots=True, kw_only=True)
class LimitedQuantity:
    """What a constraint limits, as it was observed.

    Attributes
    ----------
    object : what it belongs to
    limit : in picoseconds; None if the constraint is kept or not, without a number
    violation : why the constraint is not kept, whatever the values are
    violated_at : when that was first seen, in picoseconds
    """

    object: str
    quantity: str
    limit: Time | None
    values: LimitedValues
    is_upper: bool = True
    is_time: bool = True
    violation: str = ""
    violated_at: Fraction | None = None


def limited_values(limit: Limit, process: ProcessObservation, duration: Time, period: Time | None) -> LimitedValues:
    """What a requirement on a process limits; each job has to keep a limit of a time or of a number of preemptions or migrations.

    Parameters
    ----------
    period : the nominal one; None if there is none
    """
    match limit:
        case JitterLimit(metric=metric):
            of_times = limited_values(TimeLimit(metric=metric, value=limit.value), process, duration, period)
            return _jitter(metric, of_times, process.jobs, process.name, period)
        case TimeLimit(metric=TimeMetric.CORE_EXECUTION_TIME) if process.migrations.total:
            return LimitedValues(reason="jobs migrate, and their execution times on each core are not observed")
        case TimeLimit(metric=TimeMetric.RESPONSE_TIME):
            found = process.response_time
            pending = process.longest_unfinished
            if found is None:
                return LimitedValues(pending=pending, reason=_missing(process))
            return replace(LimitedValues.of(found, ""), pending=pending)
        case TimeLimit(metric=metric) if metric in _METRICS:
            return LimitedValues.of(process.metrics.get(_METRICS[metric]), _missing(process, _METRICS[metric]))
        case CountLimit(metric=CountMetric.PREEMPTIONS) if process.jobs:
            return LimitedValues(low=Fraction(process.preemptions.min), high=Fraction(process.preemptions.max))
        case CountLimit(metric=CountMetric.FULL_MIGRATIONS) if process.jobs:
            return LimitedValues(low=Fraction(process.migrations.min), high=Fraction(process.migrations.max))
        case CountLimit(metric=CountMetric.LOST_ACTIVATIONS):
            return LimitedValues.only(process.lost_activations)
        case CountLimit(metric=CountMetric.BOUNDED_MIGRATIONS | CountMetric.FULL_MIGRATIONS) if process.core is not None:
            return LimitedValues.only(0)
        case CountLimit(metric=CountMetric.ACTIVATIONS, bound=bound, value=value):
            activations = process.jobs + process.unfinished
            if bound is Bound.LOWER and activations < value:
                return LimitedValues(reason=f"the run is too short: there were {activations:,} activations")
            return LimitedValues.only(activations)
        case LoadLimit(core=core) if core is not None and process.core is None:
            return LimitedValues(reason=f"jobs can run on several cores, and their load on {core!r} alone is not observed")
        case LoadLimit(core=core) if core not in (None, process.core):
            return LimitedValues.only(0)
        case LoadLimit(metric=LoadMetric.LOAD):
            return LimitedValues.only(process.load)
        case LoadLimit(metric=metric) if metric in _SHARES:
            times = process.metrics.get(_SHARES[metric])
            return LimitedValues.only(0 if times is None else times.total / duration)
        case RatioLimit(metric=metric) if metric in _RATIOS:
            return _normalized(process, _RATIOS[metric])
    return LimitedValues(reason=f"the simulation does not observe the {limit.metric}")


def limited_values_of_runnable(limit: Limit, runnable: RunnableObservation) -> LimitedValues:
    """What a requirement on a runnable limits; each execution has to keep it."""
    missing = f"no execution of {runnable.name!r} ended"
    match limit:
        case CountLimit(metric=CountMetric.ACTIVATIONS):
            return LimitedValues(reason="only processes are activated")
        case JitterLimit(metric=metric):
            of_times = limited_values_of_runnable(TimeLimit(metric=metric, value=limit.value), runnable)
            return _jitter(metric, of_times, runnable.executions, runnable.name, period=None)
        case TimeLimit(metric=TimeMetric.CORE_EXECUTION_TIME) if runnable.migrations.total:
            return LimitedValues(reason="jobs migrate, and their execution times on each core are not observed")
        case TimeLimit(metric=TimeMetric.LATENESS | TimeMetric.ACTIVATE_TO_ACTIVATE as metric):
            return LimitedValues(reason=f"a runnable has no {metric} of its own")
        case TimeLimit(metric=metric) if metric in _METRICS:
            few = missing if not runnable.executions else f"only one execution of {runnable.name!r} ended"
            return LimitedValues.of(runnable.metrics.get(_METRICS[metric]), few)
        case CountLimit(metric=CountMetric.PREEMPTIONS) if runnable.executions:
            return LimitedValues(low=Fraction(runnable.preemptions.min), high=Fraction(runnable.preemptions.max))
        case CountLimit(metric=CountMetric.FULL_MIGRATIONS) if runnable.executions:
            return LimitedValues(low=Fraction(runnable.migrations.min), high=Fraction(runnable.migrations.max))
        case CountLimit(metric=CountMetric.PREEMPTIONS | CountMetric.FULL_MIGRATIONS):
            return LimitedValues(reason=missing)
    return LimitedValues(reason=f"the simulation does not observe the {limit.metric} of runnables")


def _jitter(metric: TimeMetric, times: LimitedValues, count: int, name: str, period: Time | None) -> LimitedValues:
    """The jitter of times that were observed in a number of jobs or executions."""
    if is_deviation_from_period(metric):
        return LimitedValues(reason=f"{name!r} has no nominal period") if period is None else times.jitter(period)
    return LimitedValues(reason=f"only one job of {name!r} ended") if count == 1 else times.jitter()


def _normalized(process: ProcessObservation, metric: JobMetric) -> LimitedValues:
    """A time relative to the deadline."""
    found, deadline = process.metrics.get(metric), process.deadline
    if found is None or not deadline:
        return LimitedValues(reason=_missing(process, JobMetric.LATENESS))
    return LimitedValues(low=found.min / deadline, high=found.max / deadline)


def _missing(process: ProcessObservation, metric: JobMetric = JobMetric.RESPONSE_TIME) -> str:
    """Why a metric of a process was not observed."""
    if not process.jobs:
        return f"no job of {process.name!r} ended"
    return f"{process.name!r} has no deadline" if metric is JobMetric.LATENESS else f"only one job of {process.name!r} ended"
