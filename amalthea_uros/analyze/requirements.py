"""Requirements judged by what was computed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from amalthea_uros.analyze.result import ProcessResult, RequirementResult, Verdict
from amalthea_uros.perf.constraints import Bound, TimeLimit, TimeMetric
from amalthea_uros.perf.system import System
from amalthea_uros.units import Time


def upper_response_limits(system: System) -> dict[str, Time]:
    """The deadline of processes that an upper limit of the response time gives; of several the shortest."""
    found: dict[str, Time] = {}
    for requirement in system.constraints.requirements:
        match requirement.limit:
            case TimeLimit(metric=TimeMetric.RESPONSE_TIME, bound=Bound.UPPER, value=value) if requirement.process:
                found[requirement.process] = min(value, found.get(requirement.process, value))
    return found


def judge(system: System, processes: Mapping[str, ProcessResult]) -> Iterator[RequirementResult]:
    """The verdict on each limit of a time; limits of something else are left to other analyses."""
    for requirement in system.constraints.requirements:
        limit = requirement.limit
        if not isinstance(limit, TimeLimit):
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
    """The greatest or least value of a metric; None if it is not bounded, or not computed."""
    response = process.response
    match metric:
        case TimeMetric.RESPONSE_TIME if response is not None:
            return response.worst if is_upper else response.best
        case TimeMetric.NET_EXECUTION_TIME | TimeMetric.RUNNING_TIME | TimeMetric.CORE_EXECUTION_TIME:
            return process.wcet if is_upper else process.bcet
    return None


def _verdict(process: ProcessResult | None, limit: TimeLimit, value: Time | None) -> Verdict:
    if value is None:
        is_endless = process is not None and process.response is not None and process.response.worst is None
        return Verdict.UNBOUNDED if is_endless and limit.metric is TimeMetric.RESPONSE_TIME else Verdict.UNKNOWN
    holds = value <= limit.value if limit.bound is Bound.UPPER else value >= limit.value
    return Verdict.MET if holds else Verdict.MISSED
