"""The results of all processes: response times, deadlines and metrics."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from amalthea_uros._internal.by_name import Results
from amalthea_uros.analyze.constraints.process_evidence import evidence_of, judged
from amalthea_uros.analyze.executor_results import METRICS_OF_ITERATIONS, of_iterations
from amalthea_uros.analyze.loads import without_doubtful_overload
from amalthea_uros.analyze.response_times.core_schedule import CoreSchedules
from amalthea_uros.analyze.response_times.metrics import MetricEvaluator
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.results.processes import ProcessResult
from amalthea_uros.executors.results import ExecutorResult
from amalthea_uros.judge.limits import deadline_of
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.perf.software import Preemption, Task
from amalthea_uros.timing.activation.releases import ASSUMPTION
from amalthea_uros.timing.basics.time_base import max_time, min_time
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.event_models import EventModel
from amalthea_uros.timing.jobs.executed import states_mean
from amalthea_uros.timing.response import Claim
from amalthea_uros.timing.scheduling.scheduled import EqualPriority, preemption
from amalthea_uros.units import Rounding, rounded_time_text


def process_results(
    solution: Solution, schedules: CoreSchedules, executors: Results[ExecutorResult]
) -> Iterator[ProcessResult]:
    """The results of all processes."""
    system = solution.context.system
    metrics = MetricEvaluator(solution, schedules)
    by_task = {executor.task: executor for executor in executors}
    for name in system.processes:
        found = _with_order(_process(name, solution, by_task.get(name)), solution)
        if name not in by_task:
            yield replace(found, metrics=metrics.of(found))
            continue
        known = metrics.of(found)
        yield replace(found, metrics={kind: known[kind] for kind in METRICS_OF_ITERATIONS if kind in known})


def _with_order(found: ProcessResult, solution: Solution) -> ProcessResult:
    """The result, which says so if an order of priorities could decide what is unknown."""
    item = solution.context.scheduled.get(found.name)
    if item is None or item.equal_priority is not EqualPriority.UNKNOWN or found.verdict is not Verdict.UNKNOWN:
        return found
    why = "it has no priority" if item.priority is None else "a task of its scheduler has no priority"
    if found.response is None or found.response.worst is None:
        return replace(found, reason=f"{why}; {found.reason}")
    needed = rounded_time_text(found.response.worst, Rounding.UP)
    return replace(found, reason=f"{why}; as the lowest it needs up to {needed}")


def _process(name: str, solution: Solution, executor: ExecutorResult | None) -> ProcessResult:
    """The result of a process, possibly that of the rounds of an executor; execution times are in picoseconds."""
    context, response = solution.context, without_doubtful_overload(name, solution)
    process, demand = context.system.processes[name], context.stated_demand(name)
    placement = context.placement(name)
    time_base = context.demand_model.time_base(placement.core) if placement.core else 1
    events = solution.event_models.get(name) or (context.stated_activations(name) if response is None else None)
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
        max_interarrival=events.max_interarrival if events is not None else None,
    )
    if executor is not None:
        gap = "" if name in context.demands else context.reasons.get(name, "")
        return of_iterations(found, process, executor, found.deadline, gap)
    if response is None or name in context.with_uncertain_activations or not solution.depends_on_losses(name):
        return _judged(found, events, context)
    # Without the lost jobs, others can be earlier, but not later.
    bound = replace(found, response=replace(response, claim=Claim.BOUND, best=min(response.best, found.bcet or 0)))
    if solution.follows_losses(name):
        return _judged(bound, events, context)
    # Until its first activation is lost, the schedule has all jobs.
    return replace(_judged(found, events, context), response=bound.response)


def _judged(process: ProcessResult, events: EventModel | None, context: TimingContext) -> ProcessResult:
    """The result with its verdict; what rounds of executors activate may be activated less often."""
    model = context.system.processes[process.name]
    can_borrow, may_be_less = context.can_borrow(process.name), process.name in context.with_uncertain_activations
    return judged(process, model, evidence_of(process, model, events, can_borrow, may_be_less))
