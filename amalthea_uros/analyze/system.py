"""The response times, loads, chain latencies and verdicts of a whole system."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction

from amalthea_uros.analyze.callbacks import CallbackEvaluator
from amalthea_uros.analyze.chains import counter_phases
from amalthea_uros.analyze.chains.constraints import ConstraintEvaluator
from amalthea_uros.analyze.chains.core_schedule import CoreSchedules
from amalthea_uros.analyze.chains.evaluator import ChainEvaluator
from amalthea_uros.analyze.metrics import MetricEvaluator
from amalthea_uros.analyze.propagation import solve
from amalthea_uros.analyze.requirements import evaluate_requirements
from amalthea_uros.analyze.results import Analysis, ChainResult, ProcessorResult, ProcessResult, Response, Results, Verdict
from amalthea_uros.analyze.solution import Solution
from amalthea_uros.perf.events import EventChain
from amalthea_uros.perf.software import Preemption, Task
from amalthea_uros.perf.system import System
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.overheads import COUNTED
from amalthea_uros.timing.preemption import preemption
from amalthea_uros.timing.releases import response_time_limits
from amalthea_uros.timing.settings import Settings
from amalthea_uros.units import Time


def analyze_system(system: System, settings: Settings | None = None) -> Analysis:
    """The analysis of a system."""
    if not isinstance(system, System):
        raise TypeError(
            f"expected a System, not {type(system).__name__}; extract(model).system is the system of an AMALTHEA model, "
            "describe(path).system that of an app.yaml; analyze_files(path) takes either file"
        )
    context = TimingContext.of(system, settings)
    solution = solve(context)
    _note_ignored(solution)
    evaluation = ChainEvaluator(solution)
    schedules = evaluation.timing.schedules
    processes = Results(_processes(solution, schedules))
    callbacks = Results(CallbackEvaluator(solution, schedules).all())
    chains = Results(_chains(evaluation))
    verdicts = evaluate_requirements(system, processes, callbacks, context.notes)
    requirements = Results((*verdicts, *ConstraintEvaluator(evaluation, {chain.name: chain for chain in chains}).all()))
    return Analysis(
        solution=solution,
        processors=Results(_processors(solution)),
        processes=processes,
        callbacks=callbacks,
        chains=chains,
        requirements=requirements,
        assumptions=tuple(context.notes.assumptions),
        findings=tuple(context.notes.found),
    )


def _chains(evaluation: ChainEvaluator) -> Iterator[ChainResult]:
    """The chains; over all phases of the counters at which they start if the settings say so."""
    context = evaluation.context
    for chain in context.system.events.chains:
        found = evaluation.chain(chain)
        if context.settings.all_phases and found.values:
            found = _over_all_phases(found, chain, context)
        yield found


def _over_all_phases(found: ChainResult, chain: EventChain, context: TimingContext) -> ChainResult:
    """The result of a chain over all phases of the counter at which it starts; no values if these are too many."""
    try:
        variants = [TimingContext.of(system, context.settings) for system in counter_phases.variants(chain, context)]
    except counter_phases.TooManyPhasesError as error:
        # The modelled phase must not stand for all of them.
        context.notes.warning("CHN003", f"the chain {chain.name!r} has no finite bound: {error}", chain)
        return replace(found, values=(), all_values=(), reason=str(error))
    results = [ChainEvaluator(solve(variant)).chain(chain) for variant in variants]
    return counter_phases.merged(results) if results else found


def _note_ignored(solution: Solution) -> None:
    """Report what the analysis does not take into account."""
    system, notes = solution.context.system, solution.context.notes
    overheads = {overhead.name: overhead for overhead in system.os.overheads}
    for operating_system in system.os.systems:
        overhead = overheads.get(operating_system.overhead or "")
        for service, _ in overhead.services if overhead else ():
            if service not in COUNTED:
                message = f"the overhead of {service!r} in {operating_system.name!r} is ignored"
                notes.warning("ANA006", message, overhead)
    for name, response in solution.responses.items():
        process = solution.context.scheduled[name].process
        if not isinstance(process, Task) or response.worst is None:
            continue
        jobs = solution.event_models[name].eta_plus(response.worst)
        if jobs > process.activation_limit:
            limit = process.activation_limit
            message = (
                f"{name!r} can have {jobs} pending activations, more than its activation limit {limit}; the others are lost"
            )
            notes.warning("ANA007", message, process)


def _processes(solution: Solution, schedules: CoreSchedules) -> Iterator[ProcessResult]:
    """The results of all processes."""
    system = solution.context.system
    limits, metrics = response_time_limits(system), MetricEvaluator(solution, schedules)
    for name in system.processes:
        found = _process(name, solution, limits)
        yield replace(found, metrics=metrics.of(found))


def _process(name: str, solution: Solution, limits: Mapping[str, Time]) -> ProcessResult:
    """The result of a process; execution times are in picoseconds."""
    context, response = solution.context, solution.responses.get(name)
    scheduled, demand, process = context.scheduled.get(name), context.demands.get(name), context.system.processes[name]
    deadline = scheduled.deadline if scheduled is not None and scheduled.deadline is not None else limits.get(name)
    time_base = context.time_base(name) if scheduled else 1
    events = solution.event_models.get(name)
    return ProcessResult(
        name=name,
        is_isr=not isinstance(process, Task),
        processor=scheduled.core if scheduled else None,
        priority=scheduled.priority if scheduled else None,
        preemption=str(preemption(scheduled) if scheduled else getattr(process, "preemption", Preemption.PREEMPTIVE)),
        bcet=demand.best // time_base if demand else None,
        acet=demand.mean / time_base if demand else None,
        wcet=-(-demand.worst // time_base) if demand else None,
        response=response,
        deadline=deadline,
        verdict=_verdict(response, deadline),
        reason=response.reason if response is not None else solution.reasons.get(name, ""),
        min_interarrival=events.delta_min(2) if events is not None else None,
        max_interarrival=events.max_interarrival if events is not None else None,
    )


def _verdict(response: Response | None, deadline: Time | None) -> Verdict:
    if response is None:
        return Verdict.UNKNOWN
    if response.worst is None:
        return Verdict.UNBOUNDED
    if deadline is None:
        return Verdict.UNKNOWN
    return Verdict.MET if response.worst <= deadline else Verdict.MISSED


def _processors(solution: Solution) -> Iterator[ProcessorResult]:
    """The load of each core; unknown if the demand or activation of a process on it is unknown."""
    context = solution.context
    demands = context.demands
    for core in context.system.cores:
        here = [scheduled.name for scheduled in context.on_core(core)]
        is_known = all(map(solution.is_known, here))
        is_known = (
            is_known and (core, True) not in context.unanalysable_cores and (core, False) not in context.unanalysable_cores
        )
        time_base = context.demand_model.time_base(core)
        rates = {name: solution.event_models[name].rate / time_base for name in here} if is_known else {}
        yield ProcessorResult(
            name=core,
            frequency=context.demand_model.frequency(core),
            best=_sum(demands[name].mean_best * rate for name, rate in rates.items()) if is_known else None,
            mean=_sum(demands[name].mean * rate for name, rate in rates.items()) if is_known else None,
            worst=_sum(demands[name].mean_worst * rate for name, rate in rates.items()) if is_known else None,
        )


def _sum(values: Iterable[Fraction]) -> Fraction:
    return sum(values, Fraction(0))
