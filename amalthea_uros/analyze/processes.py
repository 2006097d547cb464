"""The result of a process: response time, deadline and verdict."""

from __future__ import annotations

from dataclasses import replace

from amalthea_uros.analyze.loads import share_of_core, without_doubtful_overload
from amalthea_uros.analyze.response_times.propagation import activated_with
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.results.processes import ProcessResult
from amalthea_uros.executors.bounds.solved_system import METHOD
from amalthea_uros.executors.results import ExecutorResult
from amalthea_uros.executors.semantics.losses import can_be_sent_again, publications
from amalthea_uros.judge.evidence import Ends, ProcessEvidence, ProvedLoss
from amalthea_uros.judge.limits import activation_limit, deadline_limit, deadline_of
from amalthea_uros.judge.verdict import lost_jobs, prove_process
from amalthea_uros.perf.software import Preemption, Process, Task
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.releases import ASSUMPTION
from amalthea_uros.timing.basics.time_base import max_time, min_time
from amalthea_uros.timing.event_models.models import EventModel, can_be_dense
from amalthea_uros.timing.jobs.executed import states_mean
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.timing.scheduling.scheduled import preemption
from amalthea_uros.units import Time


def _is_sent(name: str, system: System) -> bool:
    """Whether an executor sends a message, or the middleware sends it again."""
    message = system.transmissions.get(name)
    is_repeated = message is not None and can_be_sent_again(message, system)
    return is_repeated or any(publication.transmission == name for publication in publications(system))


def process_result(name: str, solution: Solution, executor: ExecutorResult | None) -> ProcessResult:
    """The result of a process, possibly that of the rounds of an executor; execution times are in picoseconds."""
    context, response = solution.context, without_doubtful_overload(name, solution)
    process, demand = context.system.processes[name], context.stated_demand(name)
    placement = context.placement(name)
    time_base = context.demand_model.time_base(placement.core) if placement.core else 1
    migrating = solution.migrating.get(name)
    if migrating is not None:
        response, demand, time_base = migrating.response, migrating.demand, migrating.time_base
    # Iterations, and what they send, can be later than any time that is stated.
    iterates = activated_with(name, context) is not None
    is_stated = response is None and not iterates and not _is_sent(name, context.system)
    events = solution.event_models.get(name) or (context.stated_activations(name) if is_stated else None)
    if migrating is not None:
        events = migrating.events
    scheduled = context.scheduled.get(name)
    deadline = deadline_of(name, context)
    if deadline is not None and deadline.is_implicit:
        context.notes.assume(ASSUMPTION)
    found = ProcessResult(
        name=name,
        is_isr=not isinstance(process, Task),
        processor=placement.core,
        priority=placement.priority,
        preemption=str(preemption(scheduled) if scheduled else getattr(process, "preemption", Preemption.PREEMPTIVE)),
        bcet=min_time(demand.best, time_base) if demand else None,
        acet=demand.mean / time_base if demand and states_mean(process, context.system) else None,
        wcet=max_time(demand.worst, time_base) if demand else None,
        least_wcet=min_time(demand.least_worst, time_base) if demand else None,
        response=response,
        deadline=None if deadline is None else deadline.value,
        is_implicit=deadline is not None and deadline.is_implicit,
        verdict=None,
        reason=response.reason if response is not None else solution.reasons.get(name, ""),
        min_interarrival=events.delta_min(2) if events is not None else None,
        max_interarrival=events.max_interarrival if events is not None and not iterates else None,
        share=share_of_core(name, solution),
    )
    if executor is not None:
        gap = "" if name in context.demands else context.reasons.get(name, "")
        return of_iterations(found, process, executor, found.deadline, gap)
    if response is None or name in context.with_uncertain_activations or not solution.depends_on_losses(name):
        return _judged(found, events, solution)
    # Without the lost jobs, others can be earlier, but not later.
    bound = replace(found, response=replace(response, claim=Claim.BOUND, best=min(response.best, found.bcet or 0)))
    if solution.follows_losses(name):
        return _judged(bound, events, solution)
    # Until its first activation is lost, the schedule has all jobs.
    return replace(_judged(found, events, solution), response=bound.response)


def _judged(process: ProcessResult, events: EventModel | None, solution: Solution) -> ProcessResult:
    """The result with its verdict."""
    return judged(process, solution.context.system.processes[process.name], evidence_of(process, events, solution))


def of_iterations(
    process: ProcessResult, model: Process, executor: ExecutorResult, deadline: Time | None, gap: str
) -> ProcessResult:
    """The result of the process that executes the iterations of an executor: its response time is that of an iteration, after its wait.

    Without a deadline, it is met if all callbacks have a bound, nothing is lost, and the core is left to others.

    Parameters
    ----------
    deadline : that is stated for it; it has no implicit one, because its iterations follow each other
    gap : why it is unknown how much its iterations execute, as when they follow each other without rest; "" if it is known
    """
    response = Response(
        worst=executor.round.most,
        best=executor.round.least,
        method=METHOD,
        source="ros2/rclc executor.c",
        claim=Claim.BOUND,
        reason=executor.reason,
    )
    found = replace(
        process,
        response=response,
        least_wcet=None,
        deadline=deadline,
        is_implicit=False,
        reason=executor.reason,
        min_interarrival=executor.loop.least or None,
        max_interarrival=executor.loop.most,
    )
    overload = next((handle.response.reason for handle in executor.handles if handle.response.is_overload), None)
    loss = _loss(executor)
    possible = loss.reason if loss is not None and not loss.is_certain else None
    evidence = ProcessEvidence(
        response=found.worst_response,
        overload=overload,
        loss=loss,
        gap=possible or _unserved(executor) or gap or None,
        is_served=True,
    )
    return judged(found, model, evidence)


def _loss(executor: ExecutorResult) -> ProvedLoss | None:
    """What callbacks lose for certain, or may lose; values that newer ones replace are not lost."""
    lost = [
        (handle.name, handle.lost) for handle in executor.handles if handle.lost is not None and not handle.lost.is_replaced
    ]
    for name, loss in sorted(lost, key=lambda pair: not pair[1].is_certain):
        return ProvedLoss(f"{name!r} {'loses' if loss.is_certain else 'can lose'} {loss.what}", loss.is_certain)
    return None


def _unserved(executor: ExecutorResult) -> str | None:
    """Why it is unknown whether all callbacks are called in time; None if all have a bound."""
    unknown = next((handle for handle in executor.handles if handle.response.worst is None), None)
    return None if unknown is None else f"{unknown.name!r}: {unknown.response.reason}"


def judged(process: ProcessResult, model: Process, evidence: ProcessEvidence) -> ProcessResult:
    """The result with its verdict."""
    limit = None if process.deadline is None else deadline_limit(model, process.deadline, process.is_implicit)
    found = prove_process(limit, evidence)
    if found is None:
        return process
    return replace(process, verdict=found.verdict, failure=found.failure, reason=found.reason or process.reason)


def evidence_of(process: ProcessResult, events: EventModel | None, solution: Solution) -> ProcessEvidence:
    """What is proved of a process by its response time and the event model of its activations."""
    response, context = process.response, solution.context
    if response is None or events is None:
        return ProcessEvidence(gap=process.reason)
    # What rounds of executors activate may be activated less often, so that neither an overload nor a loss is certain.
    may_be_less = process.name in context.with_uncertain_activations
    if response.worst is None:
        # It may execute more than what its demand was compared with.
        is_certain = response.is_overload and not context.can_borrow(process.name) and not may_be_less
        return ProcessEvidence(overload=process.reason) if is_certain else ProcessEvidence(gap=process.reason)
    model, loss = context.system.processes[process.name], None
    if isinstance(model, Task):
        loss = lost_jobs(activation_limit(model), pending(process, events, solution))
    if loss is not None and may_be_less:
        loss = ProvedLoss(loss.reason, is_certain=False)
    return ProcessEvidence(response=process.worst_response, loss=loss)


def pending(process: ProcessResult, events: EventModel, solution: Solution) -> Ends:
    """Between which ends the maximum number of pending jobs lies: the activations while a job of the longest response is pending."""
    ends = process.worst_response
    upper = None if ends.upper is None else solution.most_pending(process.name, events, ends.upper)
    # Other event models only bound the activations.
    lower = events.eta_plus(ends.lower or 0) if can_be_dense(events) else 1
    return Ends(lower, upper)
