"""What is proved of the metrics that requirements limit, and limits that nobody can have meant."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TypeAlias

from amalthea_uros._internal.by_name import Results
from amalthea_uros.analyze.response_times import metrics
from amalthea_uros.analyze.results.processes import CallbackResult, Metric, ProcessResult, RequirementResult
from amalthea_uros.judge.evidence import Ends
from amalthea_uros.judge.limits import SystemLimit, is_from_period, limits_of, nominal_period
from amalthea_uros.judge.verdict import Verdict, prove, unknown
from amalthea_uros.perf.constraints import Requirement, TimeMetric
from amalthea_uros.perf.named import Named
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.notes import AnalysisNotes
from amalthea_uros.timing.basics.quantities import JobMetric, jitter_of
from amalthea_uros.units import HOUR, Time, time_text

#: What the analysis computes; a running time is bounded by the net execution time, and each kind of waiting by all waiting.
_METRICS = {
    TimeMetric.RESPONSE_TIME: JobMetric.RESPONSE_TIME,
    TimeMetric.NET_EXECUTION_TIME: JobMetric.NET_EXECUTION_TIME,
    TimeMetric.CORE_EXECUTION_TIME: JobMetric.NET_EXECUTION_TIME,
    TimeMetric.RUNNING_TIME: JobMetric.NET_EXECUTION_TIME,
    TimeMetric.GROSS_EXECUTION_TIME: JobMetric.GROSS_EXECUTION_TIME,
    TimeMetric.START_DELAY: JobMetric.INITIAL_PENDING_TIME,
    TimeMetric.READY_TIME: JobMetric.READY_TIME,
    TimeMetric.WAITING_TIME: JobMetric.WAITING_TIME,
    TimeMetric.PARKING_TIME: JobMetric.WAITING_TIME,
    TimeMetric.POLLING_TIME: JobMetric.WAITING_TIME,
    TimeMetric.LATENESS: JobMetric.LATENESS,
    TimeMetric.ACTIVATE_TO_ACTIVATE: JobMetric.ACTIVATE_TO_ACTIVATE,
    TimeMetric.START_TO_START: JobMetric.START_TO_START,
    TimeMetric.END_TO_END: JobMetric.END_TO_END,
    TimeMetric.END_TO_START: JobMetric.END_TO_START,
}
#: Those that are only bounded by what is computed, so that their jitter is not.
_BOUNDED_BY_OTHERS = (
    TimeMetric.CORE_EXECUTION_TIME,
    TimeMetric.RUNNING_TIME,
    TimeMetric.WAITING_TIME,
    TimeMetric.PARKING_TIME,
    TimeMetric.POLLING_TIME,
)
#: Whose metrics a requirement limits.
Holder: TypeAlias = ProcessResult | CallbackResult


def evaluate_requirements(
    system: System, processes: Results[ProcessResult], callbacks: Sequence[CallbackResult], notes: AnalysisNotes
) -> Iterator[RequirementResult]:
    """The verdict on each time limit; other limits are not evaluated, so that their verdict is unknown."""
    by_name = {process.name: process for process in processes}
    by_runnable: dict[str | None, list[CallbackResult]] = {}
    for callback in callbacks:
        by_runnable.setdefault(callback.name, []).append(callback)
    for requirement in system.constraints.requirements:
        (limit,) = limits_of(requirement)
        if not isinstance(requirement.limit.metric, TimeMetric):
            reason = f"it limits {limit.quantity}, which is not a time"
            notes.warning("ANA009", f"the requirement {requirement.name!r} is not evaluated: {reason}", requirement)
            yield RequirementResult.of(limit, unknown(reason))
            continue
        process = by_name.get(requirement.process or "")
        holders = [process] if process is not None else by_runnable.get(requirement.runnable, ())
        result = _judged(limit, requirement.limit.metric, holders, system)
        report_implausible(result, requirement, notes)
        yield result


def _judged(limit: SystemLimit, metric: TimeMetric, holders: Sequence[Holder], system: System) -> RequirementResult:
    reason = _missing(limit, metric, holders)
    if not limit.is_jitter:
        ends = _ends(holders, metric, limit.is_upper)
        is_infinite = metric is TimeMetric.RESPONSE_TIME and any(map(_is_overloaded, holders))
        return RequirementResult.of(limit, prove(limit, replace(ends, is_infinite=is_infinite), reason))
    if not is_from_period(limit):
        ends, spread = _peak_to_peak(holders, metric)
        return RequirementResult.of(limit, replace(prove(limit, ends, reason), spread=spread))
    period = nominal_period(limit, system)
    if holders and period is None:
        reason = f"{limit.object!r} is not activated by exactly one periodic stimulus, so it has no nominal period"
    ends = Ends() if period is None else _deviation(holders, metric, period)
    return RequirementResult.of(limit, prove(limit, ends, reason))


def _is_overloaded(holder: Holder) -> bool:
    """Whether it is certain that response times grow without a limit."""
    if isinstance(holder, ProcessResult):
        return holder.verdict is Verdict.UNBOUNDED
    return holder.response is not None and holder.response.is_overload


def _peak_to_peak(holders: Sequence[Holder], metric: TimeMetric) -> tuple[Ends, tuple[Time, Time] | None]:
    """Between which ends the maximum minus the minimum of a metric lies, in all runs; and minimum and maximum, if they are known."""
    found = None if metric in _BOUNDED_BY_OTHERS else _metric(holders, metric)
    if found is None or found.min is None or found.max is None:
        return Ends(), None
    return Ends(found.least_jitter, jitter_of(found.min, found.max)), (found.min, found.max)


def _deviation(holders: Sequence[Holder], metric: TimeMetric, period: Time) -> Ends:
    """Between which ends the largest deviation of a metric from the nominal period lies."""
    found = _metric(holders, metric)
    if found is None or found.min is None or found.max is None:
        return Ends()
    lower = None if found.attained is None else jitter_of(*found.attained, period)
    return Ends(lower, jitter_of(found.min, found.max, period))


def _missing(limit: SystemLimit, metric: TimeMetric, holders: Sequence[Holder]) -> str:
    """Why nothing is known of a metric."""
    if not holders and isinstance(limit.item, Requirement) and limit.item.runnable is not None:
        return f"no process of the model calls {limit.item.runnable!r}"
    if not holders:
        return "the process that it limits is not defined, or was left out when reading"
    stated = next((holder.reason for holder in holders if holder.reason), "")
    return stated or f"the {metric} of {holders[0].name!r} is not computed"


def _ends(holders: Sequence[Holder], metric: TimeMetric, is_upper: bool) -> Ends:
    """Between which ends the limited maximum or minimum of a metric of a process lies, or of a runnable in all that call it.

    Every job is between the bounds, so that the maximum is not below the lower one, and the minimum not above the upper one.
    """
    found = _metric(holders, metric)
    if found is None:
        return Ends()
    if not is_upper:
        return Ends(found.min, found.attained[0] if found.attained is not None else found.max)
    least = found.attained[1] if found.attained is not None else found.min
    return Ends(max(filter(None, (least, _least(holders, metric))), default=least), found.max)


def _metric(holders: Sequence[Holder], metric: TimeMetric) -> Metric | None:
    """A metric of a process, or of a runnable in all processes that call it; None if it is not computed."""
    name = _METRICS.get(metric)
    if name is None or not holders or not all(name in holder.metrics for holder in holders):
        return None
    return metrics.merged([{name: holder.metrics[name]} for holder in holders])[name]


def _least(holders: Sequence[Holder], metric: TimeMetric) -> Time | None:
    """What the longest job of a process takes at least."""
    processes = [holder for holder in holders if isinstance(holder, ProcessResult)]
    if not processes:
        return None
    if metric is TimeMetric.RESPONSE_TIME:
        return processes[0].worst_response.lower
    return processes[0].least_wcet if metric in _EXECUTION_TIMES else None


#: Times that depend on nothing but the demand.
_EXECUTION_TIMES = (TimeMetric.NET_EXECUTION_TIME, TimeMetric.RUNNING_TIME, TimeMetric.CORE_EXECUTION_TIME)

#: Longer limits are certainly mistakes in the unit: a year.
MAX_LIMIT = 365 * 24 * HOUR
#: Differences, which can be negative.
_SIGNED = (TimeMetric.LATENESS, TimeMetric.END_TO_START)


def report_implausible(result: RequirementResult, item: Named, notes: AnalysisNotes) -> None:
    """Report a limit that is negative or longer than a year."""
    if result.limit is None:
        return
    if result.limit < 0 and result.quantity not in _SIGNED:
        verdict = "can never be met" if result.is_upper else "is always met"
        limit = time_text(result.limit) if result.limit > -MAX_LIMIT else "of more than a year below zero"
        notes.warning("ANA010", f"the limit {limit} of {result.name!r} is negative, so it {verdict}", item)
    elif result.limit > MAX_LIMIT:
        notes.warning("ANA010", f"the limit of {result.name!r} is longer than a year", item)
