"""Verdicts on requirements."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from amalthea_uros.analyze.implausible_limits import note_implausible
from amalthea_uros.analyze.process_verdicts import worst_response
from amalthea_uros.analyze.results import Claim, ProcessResult, RequirementResult
from amalthea_uros.analyze.verdicts import Ends, Verdict, decide, undecided
from amalthea_uros.perf.constraints import Bound, Requirement, TimeLimit, TimeMetric
from amalthea_uros.perf.system import System
from amalthea_uros.timing.notes import Notes
from amalthea_uros.units import Time


def evaluate_requirements(system: System, processes: Mapping[str, ProcessResult], notes: Notes) -> Iterator[RequirementResult]:
    """The verdict on each time limit; other limits are not evaluated, so that their verdict is unknown."""
    for requirement in system.constraints.requirements:
        limit = requirement.limit
        if isinstance(limit, TimeLimit):
            result = _judged(requirement, limit, processes.get(requirement.process or ""))
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


def _judged(requirement: Requirement, limit: TimeLimit, process: ProcessResult | None) -> RequirementResult:
    is_upper = limit.bound is Bound.UPPER
    ends = Ends() if process is None else _ends(process, limit.metric, is_upper)
    verdict = decide(ends, limit.value, is_upper)
    if is_upper and limit.metric is TimeMetric.RESPONSE_TIME and process is not None and process.verdict is Verdict.UNBOUNDED:
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
        reason="" if verdict is Verdict.MET else _reason(requirement, limit, process, ends),
    )


def _reason(requirement: Requirement, limit: TimeLimit, process: ProcessResult | None, ends: Ends) -> str:
    """Why a limit is not met, or why that is unknown; nothing if the ends show it."""
    if requirement.runnable is not None and requirement.process is None:
        return f"{requirement.runnable!r} is a runnable; only limits on tasks and interrupt service routines are evaluated"
    if process is None:
        return "the process that it limits is not defined, or was left out when reading"
    is_upper = limit.bound is Bound.UPPER
    if (ends.upper if is_upper else ends.lower) is None:
        return process.reason or f"the {limit.metric} of {process.name!r} is not computed"
    return undecided(ends, is_upper) if decide(ends, limit.value, is_upper) is Verdict.UNKNOWN else ""


def _ends(process: ProcessResult, metric: TimeMetric, is_upper: bool) -> Ends:
    """Between which ends the limited maximum or minimum of a metric lies.

    Every job is between the bounds, so that the maximum is not below the lower one, and the minimum not above the upper one.
    """
    if is_upper and metric is TimeMetric.RESPONSE_TIME:
        return worst_response(process)
    minimum, maximum = _range(process, metric)
    if is_upper and metric in _EXECUTION_TIMES:
        return Ends(process.least_wcet, maximum)
    if (
        not is_upper
        and process.response is not None
        and process.response.claim is Claim.EXACT
        and metric is TimeMetric.RESPONSE_TIME
    ):
        return Ends.exactly(process.response.best)
    return Ends(minimum, maximum)


#: Times that depend on nothing but the demand.
_EXECUTION_TIMES = (TimeMetric.NET_EXECUTION_TIME, TimeMetric.RUNNING_TIME, TimeMetric.CORE_EXECUTION_TIME)


def _range(process: ProcessResult, metric: TimeMetric) -> tuple[Time | None, Time | None]:
    """The minimum and maximum of a metric, or safe bounds of them."""
    bcet, wcet = process.bcet, process.wcet
    match metric:
        case metric if metric in _EXECUTION_TIMES:
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
        case TimeMetric.LATENESS if process.deadline is not None and not process.is_implicit:
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
