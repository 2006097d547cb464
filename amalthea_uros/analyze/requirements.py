"""Verdicts on requirements."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TypeAlias

from amalthea_uros.analyze import metrics
from amalthea_uros.analyze.implausible_limits import note_implausible
from amalthea_uros.analyze.process_verdicts import worst_response
from amalthea_uros.analyze.results import CallbackResult, JobMetric, ProcessResult, RequirementResult, Results
from amalthea_uros.analyze.verdicts import Ends, Verdict, decide, undecided
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
#: Whose metrics a requirement limits.
Holder: TypeAlias = ProcessResult | CallbackResult


def evaluate_requirements(
    system: System, processes: Results[ProcessResult], callbacks: Sequence[CallbackResult], notes: Notes
) -> Iterator[RequirementResult]:
    """The verdict on each time limit; other limits are not evaluated, so that their verdict is unknown."""
    by_name = {process.name: process for process in processes}
    by_runnable: dict[str | None, list[CallbackResult]] = {}
    for callback in callbacks:
        by_runnable.setdefault(callback.name, []).append(callback)
    for requirement in system.constraints.requirements:
        limit = requirement.limit
        if isinstance(limit, TimeLimit):
            process = by_name.get(requirement.process or "")
            calls = by_runnable.get(requirement.runnable, ())
            result = _judged(requirement, limit, [process] if process is not None else calls)
            note_implausible(result, requirement, notes)
            yield result
            continue
        reason = f"it limits {limit.metric}, which is not a time"
        notes.warning("ANA009", f"the requirement {requirement.name!r} is not evaluated: {reason}", requirement)
        yield RequirementResult(
            name=requirement.name,
            object=requirement.process or requirement.runnable or "",
            quantity=str(limit.metric),
            is_upper=limit.bound is Bound.UPPER,
            limit=None,
            verdict=Verdict.UNKNOWN,
            reason=reason,
        )


def _judged(requirement: Requirement, limit: TimeLimit, holders: Sequence[Holder]) -> RequirementResult:
    is_upper = limit.bound is Bound.UPPER
    ends = _ends(holders, limit.metric, is_upper)
    verdict = decide(ends, limit.value, is_upper)
    is_overloaded = any(isinstance(holder, ProcessResult) and holder.verdict is Verdict.UNBOUNDED for holder in holders)
    if is_upper and limit.metric is TimeMetric.RESPONSE_TIME and is_overloaded:
        verdict = Verdict.MISSED
    return RequirementResult(
        name=requirement.name,
        object=requirement.process or requirement.runnable or "",
        quantity=str(limit.metric),
        is_upper=is_upper,
        limit=limit.value,
        lower=ends.lower,
        upper=ends.upper,
        verdict=verdict,
        reason="" if verdict is Verdict.MET else _reason(requirement, limit, holders, ends),
    )


def _reason(requirement: Requirement, limit: TimeLimit, holders: Sequence[Holder], ends: Ends) -> str:
    """Why a limit is not met, or why that is unknown; nothing if the ends show it."""
    if not holders and requirement.runnable is not None:
        return f"no process of the model calls {requirement.runnable!r}"
    if not holders:
        return "the process that it limits is not defined, or was left out when reading"
    is_upper = limit.bound is Bound.UPPER
    if (ends.upper if is_upper else ends.lower) is None:
        stated = next((holder.reason for holder in holders if holder.reason), "")
        return stated or f"the {limit.metric} of {holders[0].name!r} is not computed"
    return undecided(ends, is_upper) if decide(ends, limit.value, is_upper) is Verdict.UNKNOWN else ""


def _ends(holders: Sequence[Holder], metric: TimeMetric, is_upper: bool) -> Ends:
    """Between which ends the limited maximum or minimum of a metric of a process lies, or of a runnable in all that call it.

    Every job is between the bounds, so that the maximum is not below the lower one, and the minimum not above the upper one.
    """
    name = _METRICS.get(metric)
    if name is None or not holders or not all(name in holder.metrics for holder in holders):
        return Ends()
    found = metrics.merged([holder.metrics for holder in holders])[name]
    if not is_upper:
        return Ends(found.min, found.attained[0] if found.attained is not None else found.max)
    least = found.attained[1] if found.attained is not None else found.min
    return Ends(max(filter(None, (least, _least(holders, metric))), default=least), found.max)


def _least(holders: Sequence[Holder], metric: TimeMetric) -> Time | None:
    """What the longest job of a process takes at least."""
    processes = [holder for holder in holders if isinstance(holder, ProcessResult)]
    if not processes:
        return None
    if metric is TimeMetric.RESPONSE_TIME:
        return worst_response(processes[0]).lower
    return processes[0].least_wcet if metric in _EXECUTION_TIMES else None


#: Times that depend on nothing but the demand.
_EXECUTION_TIMES = (TimeMetric.NET_EXECUTION_TIME, TimeMetric.RUNNING_TIME, TimeMetric.CORE_EXECUTION_TIME)
