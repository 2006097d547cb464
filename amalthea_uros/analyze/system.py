"""The response times, loads and verdicts of a whole system."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction

from amalthea_uros.analyze.blocking import preemption
from amalthea_uros.analyze.chains import phases
from amalthea_uros.analyze.chains.evaluate import Evaluation
from amalthea_uros.analyze.chains.judge import Judge
from amalthea_uros.analyze.chains.result import ChainResult
from amalthea_uros.analyze.core import responses_on
from amalthea_uros.analyze.known import Known
from amalthea_uros.analyze.notes import Notes
from amalthea_uros.analyze.overheads import COUNTED
from amalthea_uros.analyze.propagation import Propagation
from amalthea_uros.analyze.requirements import judge, upper_response_limits
from amalthea_uros.analyze.result import Analysis, ProcessorResult, ProcessResult, Results, Verdict
from amalthea_uros.analyze.settings import Memory, Settings
from amalthea_uros.analyze.task import Response
from amalthea_uros.perf.software import Preemption, Task
from amalthea_uros.perf.system import System
from amalthea_uros.units import Time

#: Rounds of propagation, and jobs of busy windows in all of them; irregularity that still grows then will not stop.
MOST_ROUNDS = 100
MOST_JOBS = 50_000


def analyze_system(system: System, settings: Settings | None = None) -> Analysis:
    """The analysis of a system."""
    known = prepare(system, settings)
    responses = respond(known)
    _note_left_out(known, responses)
    limits = upper_response_limits(system)
    processes = Results(_process(name, known, responses.get(name), limits) for name in system.processes)
    evaluation = Evaluation(known, responses)
    chains = Results(_chains(evaluation))
    judged = judge(system, {process.name: process for process in processes}, known.notes)
    requirements = Results((*judged, *Judge(evaluation, {chain.name: chain for chain in chains}).all()))
    return Analysis(
        processors=Results(_processors(known)),
        processes=processes,
        chains=chains,
        requirements=requirements,
        assumptions=tuple(known.notes.assumptions),
        findings=tuple(known.notes.found),
    )


def _chains(evaluation: Evaluation) -> Iterator[ChainResult]:
    """The chains, with all phases of the counters at which they start, if that is wanted."""
    known = evaluation.known
    for chain in known.system.events.chains:
        found = evaluation.chain(chain)
        if known.settings.any_phase and found.values:
            variants = [prepare(system, known.settings) for system in phases.variants(chain, known.system)]
            results = [Evaluation(variant, respond(variant)).chain(chain) for variant in variants]
            found = phases.merged(results) if results else found
        yield found


def prepare(system: System, settings: Settings | None = None) -> Known:
    """What is known of a system before response times."""
    if not isinstance(system, System):
        raise TypeError(
            f"expected a System, not {type(system).__name__}; extract(model).system is the system of an AMALTHEA model, "
            "describe(path).system that of an app.yaml; analyze_files(path) takes either file"
        )
    settings = settings or Settings()
    known = Known(system, settings)
    _note_settings(settings, known.notes)
    known.place()
    return known


def respond(known: Known) -> dict[str, Response]:
    """All response times, computed as often as they change the arrivals of others."""
    least = {name: cost.best // known.demands.grains(known.placed[name].core) for name, cost in known.costs.items()}
    propagation = Propagation(known.system, least, known.reasons)
    while True:
        responses, growing = _settle(known, propagation)
        if not growing:
            return responses
        # Without those that do not settle, and what comes behind them, the others may.
        known.unsettled |= growing
        for name in growing:
            known.give_up(name, "its response time and the arrivals of what it triggers make each other grow without an end")


def _settle(known: Known, propagation: Propagation) -> tuple[dict[str, Response], set[str]]:
    """Response times that fit to the arrivals, and the processes for which there are none."""
    responses: dict[str, Response] = {}
    work = 0
    for number in range(MOST_ROUNDS):
        before = responses
        known.find_arrivals(propagation, before)
        responses = {}
        for core in known.system.cores:
            responses |= responses_on(core, known)
        if responses == before:
            return responses, set()
        work += sum(response.jobs for response in responses.values())
        if number and work > MOST_JOBS:
            break
    return {}, {name for name, response in responses.items() if response != before.get(name)}


def _note_settings(settings: Settings, notes: Notes) -> None:
    if settings.scale != 1:
        notes.assume(f"all execution times are multiplied by {float(settings.scale):g}")
    for name, factor in settings.factors.items():
        notes.assume(f"the execution times of {name} are multiplied by {float(factor):g}")
    for label, value in settings.modes.items():
        notes.assume(f"the mode {label} is always {value}")
    if settings.memory is not Memory.NONE:
        notes.assume("accesses to memory do not wait for those of other cores")


def _note_left_out(known: Known, responses: Mapping[str, Response]) -> None:
    """Note what the system has and the analysis does not take into account."""
    system, notes = known.system, known.notes
    costs = {overhead.name: overhead for overhead in system.os.overheads}
    for operating_system in system.os.systems:
        overhead = costs.get(operating_system.overhead or "")
        for service, _ in overhead.services if overhead else ():
            if service not in COUNTED:
                message = f"the cost of {service!r} in {operating_system.name!r} is not taken into account"
                notes.warning("ANA006", message, overhead)
    for name, response in responses.items():
        process = known.placed[name].process
        if not isinstance(process, Task) or response.worst is None:
            continue
        jobs = known.arrivals[name].most(response.worst)
        if jobs > process.activation_limit:
            limit = process.activation_limit
            message = f"{name!r} can be activated {jobs} times before it ends; more than {limit} at a time are lost"
            notes.warning("ANA007", message, process)


def _process(name: str, known: Known, response: Response | None, limits: Mapping[str, Time]) -> ProcessResult:
    """What is told of a process; its costs in picoseconds."""
    placed, cost, process = known.placed.get(name), known.costs.get(name), known.system.processes[name]
    deadline = placed.deadline if placed is not None and placed.deadline is not None else limits.get(name)
    grains = known.demands.grains(placed.core) if placed else 1
    arrivals = known.arrivals.get(name)
    return ProcessResult(
        name=name,
        is_isr=not isinstance(process, Task),
        processor=placed.core if placed else None,
        priority=placed.priority if placed else None,
        preemption=str(preemption(placed) if placed else getattr(process, "preemption", Preemption.PREEMPTIVE)),
        bcet=cost.best // grains if cost else None,
        acet=cost.mean / grains if cost else None,
        wcet=-(-cost.worst // grains) if cost else None,
        response=response,
        deadline=deadline,
        verdict=_verdict(response, deadline),
        reason=response.reason if response is not None else known.reasons.get(name, ""),
        distance=arrivals.span(2) if arrivals is not None else None,
        gap=arrivals.gap if arrivals is not None else None,
    )


def _verdict(response: Response | None, deadline: Time | None) -> Verdict:
    if response is None:
        return Verdict.UNKNOWN
    if response.worst is None:
        return Verdict.UNBOUNDED
    if deadline is None:
        return Verdict.UNKNOWN
    return Verdict.MET if response.worst <= deadline else Verdict.MISSED


def _processors(known: Known) -> Iterator[ProcessorResult]:
    """The load of each core; not known where something on it is not."""
    for core in known.system.cores:
        here = [placed.process.name for placed in known.on_core(core)]
        is_known = all(name in known.costs and name in known.arrivals for name in here)
        is_known = is_known and (core, True) not in known.disturbed and (core, False) not in known.disturbed
        rates = {name: known.arrivals[name].rate / known.demands.grains(core) for name in here} if is_known else {}
        yield ProcessorResult(
            name=core,
            frequency=known.demands.frequency(core),
            best=_sum(known.costs[name].mean_best * rate for name, rate in rates.items()) if is_known else None,
            mean=_sum(known.costs[name].mean * rate for name, rate in rates.items()) if is_known else None,
            worst=_sum(known.costs[name].mean_worst * rate for name, rate in rates.items()) if is_known else None,
        )


def _sum(values: Iterable[Fraction]) -> Fraction:
    return sum(values, Fraction(0))
