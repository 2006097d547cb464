"""What an analysis says of an application, against what simulations of it show."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction

from fuzzing.contradictions import contradictions
from opponent.executors.constructs import constructs_of
from opponent.executors.descriptions import Section
from opponent.executors.tally import Tally
from simulated_calls import without_heartbeats

from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.errors import ReadError
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.perf.network import Span
from amalthea_uros.simulate.observations import MetricObservation
from amalthea_uros.simulate.options import Options, SimulationMode
from amalthea_uros.simulate.results import Simulation
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import ChainQuantity, JobMetric
from amalthea_uros.units import MILLISECOND, Duration
from amalthea_uros.uros.described import describe_content

DURATION = 500 * MILLISECOND
#: A tick of a clock need not be a whole number of picoseconds, and a response consists of some ticks.
ROUNDING = 20

#: What was observed of an object: its quantity, values and bounds.
Seen = tuple[str, MetricObservation, Span]


def false_claims(
    content: Section, tally: Tally | None = None, *, heartbeats: bool = True, runs: Sequence[Options] = ()
) -> list[str]:
    """Whatever the analysis of a description says that simulations of it refute.

    Parameters
    ----------
    tally : counts what was examined, of descriptions with all sections of a random one
    heartbeats : whether they are simulated, too; they are analysed in any case
    """
    constructs = () if tally is None else (*constructs_of(content), "all")
    tally = Tally() if tally is None else tally
    try:
        system = describe_content(content).assembly.system
    except ReadError as error:
        tally.refused[
            next((each for each in str(error).splitlines() if " error: " in each), str(error)).partition(": ")[2]
        ] += 1
        return []
    tally.applications += 1
    analysis, found = analyze_system(system), []
    greatest: dict[str, tuple[Fraction, int | None]] = {}
    for options in runs or RUNS:
        simulation = simulate_system(system if heartbeats else without_heartbeats(system), options)
        run = f"{options.mode} {options.seed}"
        found += [f"{run}: {text}" for text in (*contradictions(analysis, simulation), *_refuted(analysis, simulation))]
        for name, seen, bound in observed(analysis, simulation):
            greatest[name] = max(seen.max, greatest.get(name, (Fraction(0),))[0]), bound.most
        if options.mode is SimulationMode.BEST:
            tally.left_out.update({each.reason.partition("'")[0] for each in simulation.left_out})
    for name, (most, bound) in greatest.items():
        tally.add((*constructs, f"quantity: {name.partition(' of ')[0]}"), most, bound)
    tally.verdicts.update(
        str(each.verdict) for each in (*analysis.requirements, *analysis.processes) if each.verdict is not None
    )
    return found


def runs_of(duration: int, seeds: Iterable[int]) -> list[Options]:
    """With the least of everything, the greatest of everything, and with seeds."""
    modes = SimulationMode.BEST, SimulationMode.WORST
    sampled = (Options(duration=Duration(duration), seed=seed) for seed in seeds)
    return [*(Options(duration=Duration(duration), mode=mode) for mode in modes), *sampled]


#: The runs of an application by default.
RUNS = runs_of(DURATION, (1, 2))


def observed(analysis: Analysis, simulation: Simulation) -> Iterator[Seen]:
    """What was observed, each with the span in which it must be."""
    for executor in simulation.executors:
        result = analysis.executors[executor.name]
        rounds = simulation[result.task].metrics
        if not result.reason:
            for name, metric, span in (
                ("iteration", JobMetric.RESPONSE_TIME, result.round),
                ("loop", JobMetric.ACTIVATE_TO_ACTIVATE, result.loop),
            ):
                if metric in rounds:
                    yield f"{name} of {executor.name}", rounds[metric], span
        for handle in executor.handles:
            bound, name = result.handles[handle.name], f"{executor.name}/{handle.name}"
            if handle.response_time is not None:
                response = Span(least=bound.response.best, most=bound.response.worst)
                yield f"response of {name}", handle.response_time, response
            if handle.lateness is not None and bound.lateness is not None:
                yield f"lateness of {name}", handle.lateness, bound.lateness
    tasks = {executor.task for executor in analysis.executors}
    for process in simulation.processes:
        response = analysis.processes[process.name].response if process.name not in tasks else None
        if process.response_time is not None and response is not None:
            kind = "message" if process.name in analysis.solution.context.system.transmissions else "process"
            yield f"{kind} of {process.name}", process.response_time, Span(least=response.best, most=response.worst)
    for chain in simulation.chains:
        reaction, bounds = chain.quantities.get(ChainQuantity.REDUCED_REACTION_TIME), analysis.chains[chain.name]
        if reaction is not None:
            yield f"chain of {chain.name}", reaction, Span(least=bounds.best or 0, most=bounds.worst)


def _refuted(analysis: Analysis, simulation: Simulation) -> Iterator[str]:
    for name, seen, bound in observed(analysis, simulation):
        if bound.most is not None and seen.max > bound.most + ROUNDING:
            yield f"{name}: {_ms(seen.max)} ms observed, at most {_ms(bound.most)} ms"
        if seen.min < bound.least - ROUNDING:
            yield f"{name}: {_ms(seen.min)} ms observed, at least {_ms(bound.least)} ms"
    for executor in simulation.executors:
        result = analysis.executors[executor.name]
        for handle in executor.handles:
            bound = result.handles[handle.name]
            if handle.lost and not result.reason and bound.lost is None:
                yield f"loss of {executor.name}/{handle.name}: {handle.lost} lost, but it says that nothing can be"
    for process in simulation.processes:
        if process.lost_activations and analysis.processes[process.name].verdict is Verdict.MET:
            yield f"loss of {process.name}: {process.lost_activations} activations lost, but its deadline is met"


def _ms(time: Fraction | int) -> str:
    return f"{float(time) / MILLISECOND:.6f}"
