"""The response times, loads, chain latencies and verdicts of a whole system."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from amalthea_uros._internal.by_name import Results
from amalthea_uros.analyze.callbacks import CallbackEvaluator
from amalthea_uros.analyze.chains.evaluator import ChainEvaluator
from amalthea_uros.analyze.chains.job_chains import JobBudget
from amalthea_uros.analyze.chains.messages.evaluate import evaluate_executors_and_messages
from amalthea_uros.analyze.constraints.evaluator import ConstraintEvaluator
from amalthea_uros.analyze.constraints.process_evidence import evidence_of, judged
from amalthea_uros.analyze.constraints.requirements import evaluate_requirements
from amalthea_uros.analyze.executor_results import METRICS_OF_ITERATIONS, of_iterations
from amalthea_uros.analyze.phases.merged import Phases, merged, merged_chain
from amalthea_uros.analyze.response_times.core_schedule import CoreSchedules
from amalthea_uros.analyze.response_times.metrics import MetricEvaluator
from amalthea_uros.analyze.response_times.propagation import solve
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.chains import ChainResult
from amalthea_uros.analyze.results.processes import ProcessorResult, ProcessResult
from amalthea_uros.executors.findings import note_executors
from amalthea_uros.executors.results import ExecutorResult
from amalthea_uros.executors.semantics.loops import timing_context
from amalthea_uros.judge.limits import deadline_of
from amalthea_uros.judge.summary import summarize
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.perf.events import EventChain
from amalthea_uros.perf.network import Purpose
from amalthea_uros.perf.software import Preemption, Task
from amalthea_uros.perf.stimuli import RelativePeriodic
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.load import CoreLoad, certain_loads, suppressible
from amalthea_uros.timing.activation.phases import (
    ExternalInput,
    phase_assumptions,
    unknown_phases,
    with_stated_phases,
)
from amalthea_uros.timing.activation.releases import ASSUMPTION
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.demand.job_paths import JobDemand
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.demand.overheads import COUNTED
from amalthea_uros.timing.event_models import EventModel
from amalthea_uros.timing.jobs.executed import states_mean
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.timing.scheduling.allocation import allocated_cores
from amalthea_uros.timing.scheduling.ranks import EqualPriority, ScheduledProcess, preemption
from amalthea_uros.units import Rounding, percent_text, rounded_time_text


def analyze_system(system: System, settings: Settings | None = None) -> Analysis:
    """The analysis of a system."""
    if not isinstance(system, System):
        raise TypeError(
            f"expected a System, not {type(system).__name__}; extract(model).system is the system of an AMALTHEA model, "
            "describe(path).system that of an app.yaml; analyze_files(path) takes either file"
        )
    settings = settings or Settings()
    system = with_stated_phases(system, settings.phases)
    solution = solve(timing_context(system, settings))
    system = solution.context.system
    unknown = unknown_phases(system)
    executors, crossing = evaluate_executors_and_messages(solution)
    note_executors(executors, solution)
    every = _of_all_phases(solution, unknown, executors, crossing)
    found = every or _analysis(solution, JobBudget(), executors, crossing)
    phases, notes = phase_assumptions(system, are_all_evaluated=every is not None), solution.context.notes
    # Executors and messages are evaluated once, for all phases; if there are cases, nothing else is based on the solution for these.
    is_used = every is None or bool(executors or crossing)
    return replace(
        found,
        assumptions=tuple(dict.fromkeys((*found.assumptions, *(notes.assumptions if is_used else ()), *phases))),
        findings=tuple(dict.fromkeys((*found.findings, *(notes.found if is_used else ())))),
    )


def _of_all_phases(
    solution: Solution, unknown: Sequence[ExternalInput], executors: Results[ExecutorResult], crossing: Results[ChainResult]
) -> Analysis | None:
    """The analysis over all combinations of unknown phases; None if there are too many."""
    phases = Phases.of(solution, unknown)
    if phases is None:
        return None
    cases, budget = phases.cases, JobBudget()
    return merged(
        {number: _analysis(each, budget, executors, crossing) for number, each in phases.solutions(cases.of_everything())},
        cases,
        solution,
    )


def _analysis(
    solution: Solution, budget: JobBudget, executors: Results[ExecutorResult], crossing: Results[ChainResult]
) -> Analysis:
    """The analysis of a system; chains are evaluated for all phases of the jobs that they pass, other unknown phases are any job.

    Parameters
    ----------
    executors : those that spin in loops, for all phases
    crossing : the chains that cross wires, the agent or executors in loops, for all phases
    """
    context = solution.context
    system = context.system
    _note_ignored(solution)
    _note_regular_frames(solution)
    evaluation = ChainEvaluator(solution, budget)
    schedules = evaluation.timing.schedules
    processes = Results(_processes(solution, schedules, executors))
    callbacks = Results(CallbackEvaluator(solution, schedules, executors).all())
    known = {chain.name: chain for chain in crossing}
    chains = Results(known.get(chain.name) or _chain(chain, evaluation) for chain in system.events.chains)
    verdicts = evaluate_requirements(system, processes, callbacks, context.notes)
    requirements = Results((*verdicts, *ConstraintEvaluator(evaluation, {chain.name: chain for chain in chains}).all()))
    processors = Results(_processors(solution))
    return Analysis(
        solution=solution,
        processors=processors,
        processes=processes,
        callbacks=callbacks,
        chains=chains,
        requirements=requirements,
        summary=summarize(processors, (*processes, *requirements), context),
        assumptions=tuple(context.notes.assumptions),
        findings=tuple(context.notes.found),
        executors=executors,
    )


def _chain(chain: EventChain, evaluation: ChainEvaluator) -> ChainResult:
    """A chain, over all unknown phases of the jobs that it passes if these are not too many."""
    phases = Phases.of(evaluation.solution, evaluation.occurrences(chain))
    if phases is None:
        return evaluation.chain(chain)
    cases = phases.cases.of_chain(chain)
    results = []
    for _, solution in phases.solutions(cases):
        results.append(ChainEvaluator(solution, evaluation.budget).chain(chain))
        evaluation.context.notes.include(solution.context.notes)
    return merged_chain(results, list(cases.values()))


def _note_regular_frames(solution: Solution) -> None:
    """Tell which frames of others are taken to be on time; a DBC file states no jitter."""
    system = solution.context.system
    stimuli = {stimulus.name: stimulus for stimulus in system.stimuli.stimuli}
    regular = [
        each.name
        for each in system.network.transmissions
        if each.purpose is Purpose.FOREIGN
        and any(isinstance(stimuli.get(name), RelativePeriodic) for name in system.processes[each.name].stimuli)
    ]
    if regular:
        names = ", ".join(regular)
        solution.context.notes.assume(f"frames of others without a stated jitter never come earlier than their period: {names}")


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
        if isinstance(process, Task) and response.worst is not None and name in solution.losing:
            jobs, limit = solution.event_models[name].eta_plus(response.worst), process.activation_limit
            message = (
                f"{name!r} can have {jobs} pending activations, more than its activation limit {limit}; the others are lost"
            )
            notes.warning("ANA007", message, process)


def _processes(solution: Solution, schedules: CoreSchedules, executors: Results[ExecutorResult]) -> Iterator[ProcessResult]:
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
    context, response = solution.context, _without_doubtful_overload(name, solution)
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
        bcet=demand.best // time_base if demand else None,
        acet=demand.mean / time_base if demand and states_mean(process, context.system) else None,
        wcet=-(-demand.worst // time_base) if demand else None,
        least_wcet=demand.least_worst // time_base if demand else None,
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


def _without_doubtful_overload(name: str, solution: Solution) -> Response | None:
    """The response time of a process; without bound, but not overloaded for certain, if what overloads it may exclude each other."""
    found, context = solution.responses.get(name), solution.context
    if found is None or not found.is_overload or name not in context.scheduled:
        return found
    item = context.scheduled[name]
    here = [other for other in context.on_core(item.core) if other.rank >= item.rank and solution.is_known(other.name)]
    each = _sum(_demand(other.name, context).mean_worst * solution.event_models[other.name].rate for other in here)
    together = _load((other.name for other in here), item.core, solution)
    are_suppressed = any(solution.event_models[other.name].can_be_suppressed for other in here)
    if together.certain * context.time_base(name) == each and not are_suppressed:
        return found
    if _certain_load(here, item.core, solution) > 1:
        return replace(
            found, reason=f"overload: tasks at this priority or higher need {percent_text(together.worst, 1)} % of the core"
        )
    if together.worst <= 1:
        return replace(found, is_overload=False, reason=f"{found.reason}, if what excludes each other is added up")
    return replace(found, is_overload=False, reason=f"{found.reason}, unless modes exclude a part of it")


def _processors(solution: Solution) -> Iterator[ProcessorResult]:
    """The load of each core; unknown if the demand or activation of a process that can run on it is unknown."""
    context = solution.context
    known = {core for core in context.system.cores if _is_load_known(core, solution)}
    certain: Mapping[str, Fraction] = {}
    if len(known) < len(context.system.cores):
        uncertain = {*context.with_uncertain_activations, *suppressible(context.system, context.activations)}
        certain = certain_loads(allocated_cores(context.system), context.activations, context.demand_model, uncertain)
    for core in context.system.cores:
        best, mean, worst = _loads(core, solution) if core in known else (None, None, None)
        yield ProcessorResult(
            name=core,
            frequency=context.demand_model.frequency(core),
            best=best,
            mean=mean,
            worst=worst,
            at_least=certain.get(core, Fraction(0)) if worst is None else _certain_load(context.on_core(core), core, solution),
        )


def _loads(core: str, solution: Solution) -> tuple[Fraction, Fraction | None, Fraction]:
    """The best, mean and worst load of a core; no mean if conditions may suppress activations, or execution times have none."""
    context = solution.context
    here = context.on_core(core)
    names = [item.name for item in here]
    load, regular = _load(names, core, solution), _never_suppressed(names, solution)
    if regular != names:
        return _load(regular, core, solution).best, None, load.worst
    has_mean = all(states_mean(item.process, context.system) for item in here)
    return load.best, load.mean if has_mean else None, load.worst


def _is_load_known(core: str, solution: Solution) -> bool:
    """Whether all processes that can run on a core run nowhere else, and their demand and activations are known."""
    return solution.is_closed(core) and all(solution.is_known(item.name) for item in solution.context.on_core(core))


def _load(names: Iterable[str], core: str, solution: Solution) -> JobDemand:
    """The load of a core by some of its processes."""
    context = solution.context
    demands = {name: _demand(name, context) for name in names}
    return CoreLoad(core, demands, context.activations, context.demand_model).load(solution.external_rates)


def _demand(name: str, context: TimingContext) -> MultiframeDemand:
    """The demand of a job of a process with what its scheduler needs to decide when it is activated."""
    own, decision = context.demands[name], context.decisions.get(name)
    return own if decision is None else MultiframeDemand((*own.frames, *decision.frames))


def _certain_load(items: Iterable[ScheduledProcess], core: str, solution: Solution) -> Fraction:
    """The worst load of processes of a core, without what modes may exclude for ever, and what rounds of executors need.

    Nor does it contain activations that conditions may suppress.
    """
    names = (item.name for item in items if item.name not in solution.context.with_uncertain_activations)
    return _load(_never_suppressed(names, solution), core, solution).certain


def _never_suppressed(names: Iterable[str], solution: Solution) -> list[str]:
    """The processes of which no condition can suppress activations."""
    return [name for name in names if not solution.event_models[name].can_be_suppressed]


def _sum(values: Iterable[Fraction]) -> Fraction:
    return sum(values, Fraction(0))
