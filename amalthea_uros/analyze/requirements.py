"""Verdicts on requirements."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from amalthea_uros.analyze import metrics
from amalthea_uros.analyze.results import (
    CallbackResult,
    JobMetric,
    Metric,
    ProcessResult,
    RequirementResult,
    Results,
    Verdict,
)
from amalthea_uros.perf.constraints import Bound, Requirement, TimeLimit, TimeMetric
from amalthea_uros.perf.system import System
from amalthea_uros.timing.notes import Notes
from amalthea_uros.units import Time

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


def evaluate_requirements(
    system: System, processes: Results[ProcessResult], callbacks: Sequence[CallbackResult], notes: Notes
) -> Iterator[RequirementResult]:
    """The verdict on each time limit; other limits are reported as not evaluated."""
    by_name = {process.name: process for process in processes}
    for requirement in system.constraints.requirements:
        limit = requirement.limit
        if not isinstance(limit, TimeLimit):
            notes.warning(
                "ANA009",
                f"the requirement {requirement.name!r} is not evaluated: it limits {limit.metric}, which is not a time",
                requirement,
            )
            continue
        is_upper = limit.bound is Bound.UPPER
        process = by_name.get(requirement.process or "")
        calls = [callback for callback in callbacks if callback.name == requirement.runnable]
        metric = _metric([process] if process is not None else calls, limit.metric)
        value = None if metric is None else metric.max if is_upper else metric.min
        yield RequirementResult(
            name=requirement.name,
            object=requirement.process or requirement.runnable or "",
            quantity=str(limit.metric),
            is_upper=is_upper,
            limit=limit.value,
            value=value,
            verdict=_verdict(process, limit, value),
            reason="" if value is not None else _reason(requirement, [process] if process is not None else calls),
        )


def _metric(holders: Sequence[ProcessResult | CallbackResult], metric: TimeMetric) -> Metric | None:
    """The metric of a process, or of a runnable in all processes that call it; None if it is unknown."""
    name = _METRICS.get(metric)
    if name is None or not holders or not all(name in holder.metrics for holder in holders):
        return None
    return metrics.merged([holder.metrics for holder in holders])[name]


def _reason(requirement: Requirement, holders: Sequence[ProcessResult | CallbackResult]) -> str:
    """Why a metric is unknown."""
    if not holders and requirement.runnable is not None:
        return f"no process of the model calls {requirement.runnable!r}"
    stated = next((holder.reason for holder in holders if holder.reason), "")
    return stated or f"the {requirement.limit.metric} of {(requirement.process or requirement.runnable)!r} is unknown"


def _verdict(process: ProcessResult | None, limit: TimeLimit, value: Time | None) -> Verdict:
    if value is None:
        is_unbounded = process is not None and process.response is not None and process.response.worst is None
        return Verdict.UNBOUNDED if is_unbounded and limit.metric is TimeMetric.RESPONSE_TIME else Verdict.UNKNOWN
    holds = value <= limit.value if limit.bound is Bound.UPPER else value >= limit.value
    return Verdict.MET if holds else Verdict.MISSED
