"""What a requirement limits, as it was observed."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

from amalthea_uros.judge.evidence import ObservedValues
from amalthea_uros.judge.limits import JOB_METRICS, SystemLimit
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
from amalthea_uros.timing.basics.quantities import JobMetric, is_deviation_from_period
from amalthea_uros.units import Time

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


class LimitedQuantity(NamedTuple):
    """A limit, and what was observed of the quantity."""

    limit: SystemLimit
    values: ObservedValues


def observed_values(found: MetricObservation | None, reason: str) -> ObservedValues:
    """Those of a time, or the reason why there is none."""
    if found is None:
        return ObservedValues(reason=reason)
    return ObservedValues(low=found.min, high=found.max, low_at=found.at_min.time, high_at=found.at_max.time)


def limited_values(limit: Limit, process: ProcessObservation, duration: Time, period: Time | None) -> ObservedValues:
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
            return ObservedValues(reason="jobs migrate, and their execution times on each core are not observed")
        case TimeLimit(metric=TimeMetric.RESPONSE_TIME):
            found = process.response_time
            pending = process.longest_unfinished
            if found is None:
                return ObservedValues(pending=pending, reason=_missing(process))
            return replace(observed_values(found, ""), pending=pending)
        case TimeLimit(metric=metric) if metric in JOB_METRICS:
            return observed_values(process.metrics.get(JOB_METRICS[metric]), _missing(process, JOB_METRICS[metric]))
        case CountLimit(metric=CountMetric.PREEMPTIONS) if process.jobs:
            return ObservedValues(low=Fraction(process.preemptions.min), high=Fraction(process.preemptions.max))
        case CountLimit(metric=CountMetric.FULL_MIGRATIONS) if process.jobs:
            return ObservedValues(low=Fraction(process.migrations.min), high=Fraction(process.migrations.max))
        case CountLimit(metric=CountMetric.LOST_ACTIVATIONS):
            return ObservedValues.only(process.lost_activations)
        case CountLimit(metric=CountMetric.BOUNDED_MIGRATIONS | CountMetric.FULL_MIGRATIONS) if process.core is not None:
            return ObservedValues.only(0)
        case CountLimit(metric=CountMetric.ACTIVATIONS, bound=bound, value=value):
            activations = process.jobs + process.unfinished
            if bound is Bound.LOWER and activations < value:
                return ObservedValues(reason=f"the run is too short: there were {activations:,} activations")
            return ObservedValues.only(activations)
        case LoadLimit(core=core) if core is not None and process.core is None:
            return ObservedValues(reason=f"jobs can run on several cores, and their load on {core!r} alone is not observed")
        case LoadLimit(core=core) if core not in (None, process.core):
            return ObservedValues.only(0)
        case LoadLimit(metric=LoadMetric.LOAD):
            return ObservedValues.only(process.load)
        case LoadLimit(metric=metric) if metric in _SHARES:
            times = process.metrics.get(_SHARES[metric])
            return ObservedValues.only(0 if times is None else times.total / duration)
        case RatioLimit(metric=metric) if metric in _RATIOS:
            return _normalized(process, _RATIOS[metric])
    return ObservedValues(reason=f"the simulation does not observe the {limit.metric}")


def limited_values_of_runnable(limit: Limit, runnable: RunnableObservation) -> ObservedValues:
    """What a requirement on a runnable limits; each execution has to keep it."""
    missing = f"no execution of {runnable.name!r} ended"
    match limit:
        case CountLimit(metric=CountMetric.ACTIVATIONS):
            return ObservedValues(reason="only processes are activated")
        case JitterLimit(metric=metric):
            of_times = limited_values_of_runnable(TimeLimit(metric=metric, value=limit.value), runnable)
            return _jitter(metric, of_times, runnable.executions, runnable.name, period=None)
        case TimeLimit(metric=TimeMetric.CORE_EXECUTION_TIME) if runnable.migrations.total:
            return ObservedValues(reason="jobs migrate, and their execution times on each core are not observed")
        case TimeLimit(metric=TimeMetric.LATENESS | TimeMetric.ACTIVATE_TO_ACTIVATE as metric):
            return ObservedValues(reason=f"a runnable has no {metric} of its own")
        case TimeLimit(metric=metric) if metric in JOB_METRICS:
            few = missing if not runnable.executions else f"only one execution of {runnable.name!r} ended"
            return observed_values(runnable.metrics.get(JOB_METRICS[metric]), few)
        case CountLimit(metric=CountMetric.PREEMPTIONS) if runnable.executions:
            return ObservedValues(low=Fraction(runnable.preemptions.min), high=Fraction(runnable.preemptions.max))
        case CountLimit(metric=CountMetric.FULL_MIGRATIONS) if runnable.executions:
            return ObservedValues(low=Fraction(runnable.migrations.min), high=Fraction(runnable.migrations.max))
        case CountLimit(metric=CountMetric.PREEMPTIONS | CountMetric.FULL_MIGRATIONS):
            return ObservedValues(reason=missing)
    return ObservedValues(reason=f"the simulation does not observe the {limit.metric} of runnables")


def _jitter(metric: TimeMetric, times: ObservedValues, count: int, name: str, period: Time | None) -> ObservedValues:
    """The jitter of times that were observed in a number of jobs or executions."""
    if is_deviation_from_period(metric):
        return ObservedValues(reason=f"{name!r} has no nominal period") if period is None else times.jitter(period)
    return ObservedValues(reason=f"only one job of {name!r} ended") if count == 1 else times.jitter()


def _normalized(process: ProcessObservation, metric: JobMetric) -> ObservedValues:
    """A time relative to the deadline."""
    found, deadline = process.metrics.get(metric), process.deadline
    if found is None or not deadline:
        return ObservedValues(reason=_missing(process, JobMetric.LATENESS))
    return ObservedValues(low=found.min / deadline, high=found.max / deadline)


def _missing(process: ProcessObservation, metric: JobMetric = JobMetric.RESPONSE_TIME) -> str:
    """Why a metric of a process was not observed."""
    if not process.jobs:
        return f"no job of {process.name!r} ended"
    return f"{process.name!r} has no deadline" if metric is JobMetric.LATENESS else f"only one job of {process.name!r} ended"
