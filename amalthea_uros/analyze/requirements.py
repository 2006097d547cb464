"""Verdicts on requirements."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from amalthea_uros.analyze.results import ProcessResult, RequirementResult, Verdict
from amalthea_uros.perf.constraints import Bound, TimeLimit, TimeMetric
from amalthea_uros.perf.system import System
from amalthea_uros.timing.notes import Notes
from amalthea_uros.units import Time


def evaluate_requirements(system: System, processes: Mapping[str, ProcessResult], notes: Notes) -> Iterator[RequirementResult]:
    """The verdict on each time limit; other limits are reported as not evaluated."""
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
    """The maximum or minimum of a metric; None if it is unbounded or unknown."""
    minimum, maximum = _range(process, metric)
    return maximum if is_upper else minimum


def _range(process: ProcessResult, metric: TimeMetric) -> tuple[Time | None, Time | None]:
    """The minimum and maximum of a metric, or safe bounds of them."""
    bcet, wcet = process.bcet, process.wcet
    match metric:
        case TimeMetric.NET_EXECUTION_TIME | TimeMetric.RUNNING_TIME | TimeMetric.CORE_EXECUTION_TIME:
            return bcet, wcet
        case TimeMetric.ACTIVATE_TO_ACTIVATE:
            return process.min_interarrival, process.max_interarrival
    response = process.response
    if response is None or bcet is None:
        return None, None
    best, worst = response.best, response.worst
    if worst is None:
        return (best if metric is TimeMetric.RESPONSE_TIME else None), None
    # A job also executes for at least its best case, so that it cannot wait for longer than the rest of the response time.
    waiting = worst - bcet
    match metric:
        case TimeMetric.RESPONSE_TIME:
            return best, worst
        case TimeMetric.GROSS_EXECUTION_TIME:
            return bcet, worst
        case TimeMetric.START_DELAY | TimeMetric.READY_TIME:
            return 0, waiting
        case TimeMetric.WAITING_TIME | TimeMetric.PARKING_TIME | TimeMetric.POLLING_TIME:
            # Processes that wait for events are unknown, and with priority ceilings no process waits for a semaphore.
            return 0, 0
        case TimeMetric.LATENESS if process.deadline is not None:
            return best - process.deadline, worst - process.deadline
    return _between_jobs(process, metric, waiting, best, worst)


def _between_jobs(
    process: ProcessResult, metric: TimeMetric, waiting: Time, best: Time, worst: Time
) -> tuple[Time | None, Time | None]:
    """Times from one job to the next: the time between their activations, and the variation of their starts and ends."""
    if process.min_interarrival is None:
        return None, None
    match metric:
        case TimeMetric.START_TO_START:
            return max(0, process.min_interarrival - waiting), _plus(process.max_interarrival, waiting)
        case TimeMetric.END_TO_END:
            return max(0, process.min_interarrival - (worst - best)), _plus(process.max_interarrival, worst - best)
        case TimeMetric.END_TO_START:
            return process.min_interarrival - worst, _plus(process.max_interarrival, waiting - best)
    return None, None


def _plus(value: Time | None, more: Time) -> Time | None:
    return None if value is None else value + more


def _verdict(process: ProcessResult | None, limit: TimeLimit, value: Time | None) -> Verdict:
    if value is None:
        is_unbounded = process is not None and process.response is not None and process.response.worst is None
        return Verdict.UNBOUNDED if is_unbounded and limit.metric is TimeMetric.RESPONSE_TIME else Verdict.UNKNOWN
    holds = value <= limit.value if limit.bound is Bound.UPPER else value >= limit.value
    return Verdict.MET if holds else Verdict.MISSED
