"""What is proved of a process: its response time, and the activations that can be lost."""

from __future__ import annotations

from dataclasses import replace

from amalthea_uros.analyze.results.processes import ProcessResult
from amalthea_uros.judge.evidence import Ends, ProcessEvidence, ProvedLoss
from amalthea_uros.judge.limits import activation_limit, deadline_limit
from amalthea_uros.judge.verdict import lost_jobs, prove_process
from amalthea_uros.perf.software import Process, Task
from amalthea_uros.timing.event_models import EventModel, can_be_dense
from amalthea_uros.timing.response import Claim


def worst_response(process: ProcessResult) -> Ends:
    """Between which ends the worst-case response time lies: the longest job takes at least its execution time."""
    response = process.response
    if response is None:
        return Ends()
    if response.worst is not None and response.claim is Claim.EXACT:
        return Ends.exactly(response.worst)
    return Ends(max(response.best, process.least_wcet or 0), response.worst)


def judged(process: ProcessResult, model: Process, evidence: ProcessEvidence) -> ProcessResult:
    """The result with its verdict."""
    limit = None if process.deadline is None else deadline_limit(model, process.deadline, process.is_implicit)
    found = prove_process(limit, evidence)
    if found is None:
        return process
    return replace(process, verdict=found.verdict, failure=found.failure, reason=found.reason or process.reason)


def evidence_of(
    process: ProcessResult, model: Process, events: EventModel | None, can_borrow: bool, may_be_less: bool
) -> ProcessEvidence:
    """What is proved of a process by its response time and the event model of its activations.

    Parameters
    ----------
    can_borrow : whether it can execute more than what its demand was compared with, so that an overload is not certain
    may_be_less : whether it may be activated less often, so that neither an overload nor a loss is certain
    """
    response = process.response
    if response is None or events is None:
        return ProcessEvidence(gap=process.reason)
    if response.worst is None:
        is_certain = response.is_overload and not can_borrow and not may_be_less
        return ProcessEvidence(overload=process.reason) if is_certain else ProcessEvidence(gap=process.reason)
    loss = lost_jobs(activation_limit(model), pending(process, events)) if isinstance(model, Task) else None
    if loss is not None and may_be_less:
        loss = ProvedLoss(loss.reason, is_certain=False)
    return ProcessEvidence(response=worst_response(process), loss=loss)


def pending(process: ProcessResult, events: EventModel) -> Ends:
    """Between which ends the maximum number of pending jobs lies: the activations while a job of the longest response is pending."""
    ends = worst_response(process)
    upper = None if ends.upper is None else events.eta_plus(ends.upper)
    # Other event models only bound the activations.
    lower = events.eta_plus(ends.lower or 0) if can_be_dense(events) else 1
    return Ends(lower, upper)
