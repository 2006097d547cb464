"""The response times, loads, chain latencies and verdicts of a whole system."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

from amalthea_uros._internal.by_name import Results
from amalthea_uros.analyze.callbacks import CallbackEvaluator
from amalthea_uros.analyze.chains.evaluator import ChainEvaluator
from amalthea_uros.analyze.chains.job_chains import JobBudget
from amalthea_uros.analyze.constraints.evaluator import ConstraintEvaluator
from amalthea_uros.analyze.constraints.requirements import evaluate_requirements
from amalthea_uros.analyze.hosts_and_messages import executors_and_messages, solved
from amalthea_uros.analyze.loads import note_ignored, processor_results
from amalthea_uros.analyze.phases.cases import MAX_JOBS, PhaseCases, work_of
from amalthea_uros.analyze.phases.merged import merged, over_all_phases
from amalthea_uros.analyze.process_results import process_results
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.chains import ChainResult
from amalthea_uros.analyze.results.processes import ProcessorResult, ProcessResult
from amalthea_uros.executors.results import ExecutorResult
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.releases import (
    ExternalInput,
    phase_assumptions,
    unknown_phases,
    with_stated_phases,
)
from amalthea_uros.timing.basics.settings import Settings


def analyze_system(system: System, settings: Settings | None = None) -> Analysis:
    """The analysis of a system."""
    analysis = analyze_while(system, settings, lambda _analysis: True)
    assert analysis is not None
    return analysis


def analyze_while(system: System, settings: Settings | None, is_wanted: Callable[[Analysis], bool]) -> Analysis | None:
    """The analysis of a system; None as soon as what is found is not wanted.

    Parameters
    ----------
    is_wanted : asked of the analysis for each case of unknown phases, which is possible; of the only one if there are no cases
    """
    if not isinstance(system, System):
        raise TypeError(
            f"expected a System, not {type(system).__name__}; extract(model).system is the system of an AMALTHEA model, "
            "describe(path).system that of an app.yaml; analyze_files(path) takes either file"
        )
    settings = settings or Settings()
    system = with_stated_phases(system, settings.phases)
    solution = solved(system, settings)
    system = solution.context.system
    unknown = unknown_phases(system)
    executors, crossing, host = executors_and_messages(solution)
    every, is_complete = _of_all_phases(solution, unknown, executors, crossing, is_wanted)
    if not is_complete:
        return None
    found = every or _of_any_phase(solution, executors, crossing)
    if every is None and not is_wanted(found):
        return None
    phases, notes = phase_assumptions(system, are_all_evaluated=every is not None), solution.context.notes
    # Executors and messages are evaluated once, for all phases; if there are cases, nothing else is based on the solution for these.
    is_used = every is None or bool(executors or crossing)
    return replace(
        found,
        host=host,
        assumptions=tuple(dict.fromkeys((*found.assumptions, *(notes.assumptions if is_used else ()), *phases))),
        findings=tuple(dict.fromkeys((*found.findings, *(notes.found if is_used else ())))),
    )


def _of_all_phases(
    solution: Solution,
    unknown: Sequence[ExternalInput],
    executors: Results[ExecutorResult],
    crossing: Results[ChainResult],
    is_wanted: Callable[[Analysis], bool],
) -> tuple[Analysis | None, bool]:
    """The analysis over all combinations of unknown phases, None if there are too many; and whether all that was found is wanted."""
    cases, budget, chains = PhaseCases.of(solution, unknown), JobBudget(), len(solution.context.system.events.chains)
    if cases is None:
        return None, True
    of_everything, work_of_each = cases.of_everything(), work_of(cases.first, chains)
    if len(of_everything) * work_of_each > MAX_JOBS:
        return None, True
    analyses: dict[int, Analysis] = {}
    # Loads are those of whole cycles, whatever the phases.
    loads: Results[ProcessorResult] | None = None
    # The solution for unknown phases is needed before the first case.
    work = work_of(solution, chains)
    for number, each in cases.solutions(of_everything):
        same = {
            name: analyses[0].processes[name] for name, of_process in cases.of_processes.items() if number not in of_process
        }
        analyses[number] = replace(_analysis(each, budget, executors, crossing, loads, same), work=work + work_of_each)
        work = 0
        loads = analyses[number].processors
        if not is_wanted(analyses[number]):
            return None, False
    return merged(analyses, cases, solution), True


def _of_any_phase(solution: Solution, executors: Results[ExecutorResult], crossing: Results[ChainResult]) -> Analysis:
    """The analysis in which any job can take what comes from outside, but for the phases of single chains."""
    budget = JobBudget()
    analysis = _analysis(solution, budget, executors, crossing)
    return replace(analysis, work=work_of(solution, len(analysis.chains)) + budget.work)


def _analysis(
    solution: Solution,
    budget: JobBudget,
    executors: Results[ExecutorResult],
    crossing: Results[ChainResult],
    loads: Results[ProcessorResult] | None = None,
    same: Mapping[str, ProcessResult] = MappingProxyType({}),
) -> Analysis:
    """The analysis of a system; chains are evaluated for all phases of the jobs that they pass, other unknown phases are any job.

    Parameters
    ----------
    executors : those that spin in loops, for all phases
    crossing : the chains that cross wires, the agent or executors in loops, for all phases
    loads : of the cores; None if they are not known yet
    same : for phases of which some are evaluated already that are the same to these processes: results for any phase
    """
    context = solution.context
    system = context.system
    note_ignored(solution)
    evaluation = ChainEvaluator(solution, budget)
    processes = Results(process_results(solution, executors, same))
    callbacks = Results(CallbackEvaluator(solution, executors).all())
    known = {chain.name: chain for chain in crossing}
    chains = Results(known.get(chain.name) or over_all_phases(chain, evaluation) for chain in system.events.chains)
    verdicts = evaluate_requirements(system, processes, callbacks, context.notes)
    requirements = Results((*verdicts, *ConstraintEvaluator(evaluation, {chain.name: chain for chain in chains}).all()))
    return Analysis(
        solution=solution,
        processors=loads or Results(processor_results(solution)),
        processes=processes,
        callbacks=callbacks,
        chains=chains,
        requirements=requirements,
        assumptions=tuple(context.notes.assumptions),
        findings=tuple(context.notes.found),
        executors=executors,
    )
