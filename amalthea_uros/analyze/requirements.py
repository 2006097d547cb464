"""Requirements judged by what was computed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from amalthea_uros.analyze.results import ProcessResult, RequirementResult, Verdict
from amalthea_uros.perf.constraints import Bound, TimeLimit, TimeMetric
from amalthea_uros.perf.system import System
from amalthea_uros.timing.notes import Notes
from amalthea_uros.units import Time


def judge(system: System, processes: Mapping[str, ProcessResult], notes: Notes) -> Iterator[RequirementResult]:
    """The verdict on each limit of a time; limits of something else are told to be left out."""
    for requirement in system.constraints.requirements:
        limit = requirement.limit
        if not isinstance(limit, TimeLimit):
            notes.warning(
                "ANA009", f"the requirement {requirement.name!r} limits {limit.metric}, which is not judged", requirement
            )
            continue
        is_upper = limit.bound is Bound.UPPER
        process = processes.get(requirement.process or "")
        value = None if process is None else _value(process, limit.metric, is_upper)
        yield RequirementResult(
            name=requirement.name,
            object=requirement.process or requirement.runnable or "",
            quantity=str(limit.metric),
            is_upper=is_upper,
            limit=limit.value,
            value=value,
            verdict=_verdict(process, limit, value),
        )


def _value(process: ProcessResult, metric: TimeMetric, is_upper: bool) -> Time | None:
    """The greatest or least value of a metric; None if it is not bounded, or not known."""
    least, most = _range(process, metric)
    return most if is_upper else least


def _range(process: ProcessResult, metric: TimeMetric) -> tuple[Time | None, Time | None]:
    """The least and the greatest value of a metric, or safe bounds of them."""
    least, most = process.bcet, process.wcet
    match metric:
        case TimeMetric.NET_EXECUTION_TIME | TimeMetric.RUNNING_TIME | TimeMetric.CORE_EXECUTION_TIME:
            return least, most
        case TimeMetric.ACTIVATE_TO_ACTIVATE:
            return process.min_interarrival, process.max_interarrival
    response = process.response
    if response is None or least is None:
        return None, None
    best, worst = response.best, response.worst
    if worst is None:
        return (best if metric is TimeMetric.RESPONSE_TIME else None), None
    # Whatever a job waits for, it also executes: at least its best case lies behind its start and between its interruptions.
    waits = worst - least
    match metric:
        case TimeMetric.RESPONSE_TIME:
            return best, worst
        case TimeMetric.GROSS_EXECUTION_TIME:
            return least, worst
        case TimeMetric.START_DELAY | TimeMetric.READY_TIME:
            return 0, waits
        case TimeMetric.WAITING_TIME | TimeMetric.PARKING_TIME | TimeMetric.POLLING_TIME:
            # Processes that wait for others are unknown; with ceilings nobody waits for a semaphore.
            return 0, 0
        case TimeMetric.LATENESS if process.deadline is not None:
            return best - process.deadline, worst - process.deadline
    return _between_jobs(process, metric, waits, best, worst)


def _between_jobs(
    process: ProcessResult, metric: TimeMetric, waits: Time, best: Time, worst: Time
) -> tuple[Time | None, Time | None]:
    """Times from a job to the next one: the distance of their activations, and how much earlier or later both may start or end."""
    if process.min_interarrival is None:
        return None, None
    match metric:
        case TimeMetric.START_TO_START:
            return max(0, process.min_interarrival - waits), _plus(process.max_interarrival, waits)
        case TimeMetric.END_TO_END:
            return max(0, process.min_interarrival - (worst - best)), _plus(process.max_interarrival, worst - best)
        case TimeMetric.END_TO_START:
            return process.min_interarrival - worst, _plus(process.max_interarrival, waits - best)
    return None, None


def _plus(value: Time | None, more: Time) -> Time | None:
    return None if value is None else value + more


def _verdict(process: ProcessResult | None, limit: TimeLimit, value: Time | None) -> Verdict:
    if value is None:
        is_endless = process is not None and process.response is not None and process.response.worst is None
        return Verdict.UNBOUNDED if is_endless and limit.metric is TimeMetric.RESPONSE_TIME else Verdict.UNKNOWN
    holds = value <= limit.value if limit.bound is Bound.UPPER else value >= limit.value
    return Verdict.MET if holds else Verdict.MISSED
