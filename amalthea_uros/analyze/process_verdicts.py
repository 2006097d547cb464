"""The verdict on a process: its deadline, and the activations that can be lost."""

from __future__ import annotations

from dataclasses import replace

from amalthea_uros.analyze.results import Claim, ProcessResult, Response
from amalthea_uros.analyze.verdicts import Ends, Failure, Verdict, decide, undecided
from amalthea_uros.perf.software import Process, Task
from amalthea_uros.timing.event_models import EventModel, can_be_dense


def worst_response(process: ProcessResult) -> Ends:
    """Between which ends the worst-case response time lies: the longest job takes at least its execution time."""
    response = process.response
    if response is None:
        return Ends()
    if response.worst is not None and response.claim is Claim.EXACT:
        return Ends.exactly(response.worst)
    return Ends(max(response.best, process.least_wcet or 0), response.worst)


def judged(process: ProcessResult, model: Process, events: EventModel | None, can_borrow: bool) -> ProcessResult:
    """The result with its verdict.

    Parameters
    ----------
    can_borrow : whether it can execute more than what its demand was compared with, so that an overload is not certain
    """
    response = process.response
    if response is None or events is None:
        return replace(process, verdict=Verdict.UNKNOWN)
    if response.worst is None:
        return _without_bound(process, response, can_borrow)
    at_deadline = None if process.deadline is None else decide(worst_response(process), process.deadline, is_upper=True)
    at_limit = decide(pending(process, events), model.activation_limit, is_upper=True) if isinstance(model, Task) else None
    if at_limit is Verdict.MISSED:
        return replace(process, verdict=Verdict.MISSED, failure=Failure.LOST, reason=_lost(process, model, events))
    if at_deadline is Verdict.MISSED:
        return replace(process, verdict=Verdict.MISSED, failure=Failure.MISSED)
    if at_deadline is Verdict.UNKNOWN:
        return replace(process, verdict=Verdict.UNKNOWN, reason=undecided(worst_response(process), is_upper=True))
    if at_limit is Verdict.UNKNOWN:
        return replace(process, verdict=Verdict.UNKNOWN, reason=_lost(process, model, events))
    return replace(process, verdict=at_deadline)


def pending(process: ProcessResult, events: EventModel) -> Ends:
    """Between which ends the maximum number of pending jobs lies: the activations while a job of the longest response is pending."""
    ends = worst_response(process)
    upper = None if ends.upper is None else events.eta_plus(ends.upper)
    # Other event models only bound the activations.
    lower = events.eta_plus(ends.lower or 0) if can_be_dense(events) else 1
    return Ends(lower, upper)


def _without_bound(process: ProcessResult, response: Response, can_borrow: bool) -> ProcessResult:
    if response.is_overload and not can_borrow:
        return replace(process, verdict=Verdict.UNBOUNDED, failure=Failure.OVERLOAD)
    return replace(process, verdict=Verdict.UNKNOWN)


def _lost(process: ProcessResult, model: Process, events: EventModel) -> str:
    assert isinstance(model, Task)
    jobs, limit = pending(process, events).upper, model.activation_limit
    return f"{jobs} jobs can be pending, and the activation limit is {limit}"
