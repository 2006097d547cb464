"""What was observed of the deadlines, requirements and constraints of a system, and the verdicts on them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from types import MappingProxyType
from typing import Protocol

from amalthea_uros._internal.by_name import Results
from amalthea_uros.errors import UnknownError
from amalthea_uros.judge.evidence import ObservedProcess, ObservedValues
from amalthea_uros.judge.limits import JOB_METRICS, EventConstraint, SystemLimit, deadline_limit, stated_limits, without_number
from amalthea_uros.judge.verdict import in_doubt, not_observed, observe, observe_process
from amalthea_uros.perf.constraints import (
    Bound,
    CountLimit,
    CountMetric,
    JitterLimit,
    LatencyConstraint,
    LatencyKind,
    Limit,
    LoadLimit,
    LoadMetric,
    RatioLimit,
    RatioMetric,
    Requirement,
    TimeLimit,
    TimeMetric,
)
from amalthea_uros.perf.events import EventChain
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.metrics.extremes import LimitedQuantity
from amalthea_uros.simulate.observations import (
    ChainObservation,
    MetricObservation,
    ProcessObservation,
    RequirementObservation,
    RunnableObservation,
)
from amalthea_uros.simulate.runs.not_simulated import LIMITED_PROCESS_LEFT_OUT
from amalthea_uros.timing.activation.releases import activation_period
from amalthea_uros.timing.basics.quantities import ChainQuantity, JobMetric, is_deviation_from_period
from amalthea_uros.timing.dataflow.chains import is_decided_by_one_path, unfold
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
        case TimeLimit(metric=metric) if metric in JOB_METRICS and not _is_of_migrating_jobs(limit, process):
            found = observed_values(process.metrics.get(JOB_METRICS[metric]), _missing(process, JOB_METRICS[metric]))
            is_pending = metric is TimeMetric.RESPONSE_TIME
            return replace(found, pending=process.longest_unfinished) if is_pending else found
        case CountLimit(metric=CountMetric.LOST_ACTIVATIONS):
            return ObservedValues.only(process.lost_activations)
        case CountLimit(metric=CountMetric.PREEMPTIONS | CountMetric.FULL_MIGRATIONS) if process.jobs:
            return _counted(limit, process)
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
            relative = process.metrics.get(_RATIOS[metric])
            if relative is None or not process.deadline:
                return ObservedValues(reason=_missing(process, JobMetric.LATENESS))
            return ObservedValues(low=relative.min / process.deadline, high=relative.max / process.deadline)
    return _not_observed(limit, process)


def limited_values_of_runnable(limit: Limit, runnable: RunnableObservation) -> ObservedValues:
    """What a requirement on a runnable limits; each execution has to keep it."""
    missing = f"no execution of {runnable.name!r} ended"
    match limit:
        case CountLimit(metric=CountMetric.ACTIVATIONS):
            return ObservedValues(reason="only processes are activated")
        case JitterLimit(metric=metric):
            of_times = limited_values_of_runnable(TimeLimit(metric=metric, value=limit.value), runnable)
            return _jitter(metric, of_times, runnable.executions, runnable.name, period=None)
        case TimeLimit(metric=TimeMetric.LATENESS | TimeMetric.ACTIVATE_TO_ACTIVATE as metric):
            return ObservedValues(reason=f"a runnable has no {metric} of its own")
        case TimeLimit(metric=metric) if metric in JOB_METRICS and not _is_of_migrating_jobs(limit, runnable):
            few = missing if not runnable.executions else f"only one execution of {runnable.name!r} ended"
            return observed_values(runnable.metrics.get(JOB_METRICS[metric]), few)
        case CountLimit(metric=CountMetric.PREEMPTIONS | CountMetric.FULL_MIGRATIONS):
            return _counted(limit, runnable) if runnable.executions else ObservedValues(reason=missing)
    return _not_observed(limit, runnable, " of runnables")


def _counted(limit: CountLimit, observed: ProcessObservation | RunnableObservation) -> ObservedValues:
    found = observed.preemptions if limit.metric is CountMetric.PREEMPTIONS else observed.migrations
    return ObservedValues(low=Fraction(found.min), high=Fraction(found.max))


def _is_of_migrating_jobs(limit: Limit, observed: ProcessObservation | RunnableObservation) -> bool:
    return limit.metric is TimeMetric.CORE_EXECUTION_TIME and observed.migrations.total > 0


def _not_observed(limit: Limit, observed: ProcessObservation | RunnableObservation, of: str = "") -> ObservedValues:
    if _is_of_migrating_jobs(limit, observed):
        return ObservedValues(reason="jobs migrate, and their execution times on each core are not observed")
    return ObservedValues(reason=f"the simulation does not observe the {limit.metric}{of}")


def _jitter(metric: TimeMetric, times: ObservedValues, count: int, name: str, period: Time | None) -> ObservedValues:
    """The jitter of times that were observed in a number of jobs or executions."""
    if is_deviation_from_period(metric):
        return ObservedValues(reason=f"{name!r} has no nominal period") if period is None else times.jitter(period)
    return ObservedValues(reason=f"only one job of {name!r} ended") if count == 1 else times.jitter()


def _missing(process: ProcessObservation, metric: JobMetric) -> str:
    """Why a metric of a process was not observed."""
    if not process.jobs:
        return f"no job of {process.name!r} ended"
    return f"{process.name!r} has no deadline" if metric is JobMetric.LATENESS else f"only one job of {process.name!r} ended"


class ConstraintObservers(Protocol):
    """What has observed the constraints."""

    def quantities(self, constraint: EventConstraint) -> Sequence[LimitedQuantity]:
        """What was observed of a constraint; nothing if it limits nothing, or cannot be observed."""

    def reason(self, constraint: EventConstraint) -> str:
        """Why nothing was observed of a constraint."""


def judge_process(process: ProcessObservation, model: Process, doubt: str = "", left_out: str = "") -> ProcessObservation:
    """The observations of a process with the verdict on its deadline and on lost activations.

    Parameters
    ----------
    doubt : why what was observed is no behaviour of the system; "" if it is one
    left_out : why it is not simulated as it is, so that nothing was observed, with a deadline or without; "" if it is
    """
    if left_out:
        return replace(process, verdict=not_observed(left_out).verdict, reason=left_out)
    limit = None if process.deadline is None else deadline_limit(model, process.deadline, process.is_implicit)
    response = replace(observed_values(process.response_time, "no job ended"), pending=process.longest_unfinished)
    found = observe_process(limit, ObservedProcess(response=response, lost_activations=process.lost_activations))
    if found is None:
        return process
    found = in_doubt(found, doubt)
    return replace(process, verdict=found.verdict, reason=found.reason)


def judge_requirements(
    system: System,
    processes: Results[ProcessObservation],
    chains: Results[ChainObservation],
    duration: Time,
    runnables: Sequence[RunnableObservation],
    observers: ConstraintObservers,
    doubts: Mapping[str, str] = MappingProxyType({}),
) -> Iterator[RequirementObservation]:
    """The verdicts on all requirements, then on all constraints.

    Parameters
    ----------
    doubts : why what was observed is no behaviour of the system, by the names of requirements and constraints
    """
    for item, limits in stated_limits(system):
        if isinstance(item, Requirement):
            values = _of_requirement(item, system, processes, duration, runnables)
            quantities: Sequence[LimitedQuantity] = [LimitedQuantity(limit, values) for limit in limits]
        elif isinstance(item, LatencyConstraint):
            quantities = [LimitedQuantity(limit, _of_chain(limit, item, chains, system)) for limit in limits]
        else:
            quantities = observers.quantities(item)
        doubt = doubts.get(item.name, "")
        observed = [(limit, in_doubt(observe(limit, values), doubt)) for limit, values in quantities]
        yield from (RequirementObservation.of(limit, judged, at=judged.at) for limit, judged in observed)
        if not quantities and not isinstance(item, Requirement):
            reason = not_observed(observers.reason(item))
            yield from (RequirementObservation.of(limit, reason) for limit in limits or [without_number(item)])


def _of_requirement(
    requirement: Requirement,
    system: System,
    processes: Results[ProcessObservation],
    duration: Time,
    runnables: Sequence[RunnableObservation],
) -> ObservedValues:
    limit = requirement.limit
    process = next((each for each in processes if each.name == requirement.process), None)
    # Of a callback, the calls of its handle count, which come last.
    runnable = next((each for each in reversed(runnables) if each.name == requirement.runnable), None)
    if process is not None:
        model = system.processes.get(process.name)
        return limited_values(limit, process, duration, None if model is None else activation_period(model, system))
    if runnable is not None:
        return limited_values_of_runnable(limit, runnable)
    if requirement.process in system.processes:
        return ObservedValues(reason=LIMITED_PROCESS_LEFT_OUT)
    kind = "process" if requirement.runnable is None else "runnable"
    return ObservedValues(reason=f"the {kind} that it limits is not defined, or was left out when reading")


def _of_chain(
    limit: SystemLimit, constraint: LatencyConstraint, chains: Results[ChainObservation], system: System
) -> ObservedValues:
    """What a latency constraint limits: data age at each response, or reaction at each stimulus, also if there is none.

    The paths through a fork are observed one by one, although only some of them decide.
    """
    model, is_age = system.chains.get(constraint.chain), constraint.kind is LatencyKind.AGE
    if constraint.kind is LatencyKind.REACTION and model is not None and _decide_some(model, limit, system):
        return ObservedValues(reason="only some of the paths through the chain decide, and each of them is observed by itself")
    chain = next((each for each in chains if each.name == constraint.chain), None)
    if chain is None:
        return ObservedValues(reason=f"the chain {constraint.chain!r} is not defined in the model")
    quantity = ChainQuantity.REDUCED_DATA_AGE if is_age else ChainQuantity.REDUCED_REACTION_TIME
    values = observed_values(chain.quantities.get(quantity), chain.reason or "there was no response to a stimulus")
    if chain.not_evaluated:
        reason = f"{chain.not_evaluated:,} latencies are longer than those that can be observed"
        values = replace(values, is_complete=False, reason=reason)
    values = values if is_age else replace(values, pending=chain.longest_unanswered)
    return values.jitter() if limit.is_jitter else values


def _decide_some(chain: EventChain, limit: SystemLimit, system: System) -> bool:
    """Whether the longest path through a chain, or the shortest one for a lower limit, does not decide on a reaction."""
    try:
        unfolded, _ = unfold(chain, system)
    except UnknownError:
        return False
    ends = (True, False) if limit.is_jitter else (limit.is_upper,)
    return not all(is_decided_by_one_path(unfolded, is_upper=is_upper) for is_upper in ends)
