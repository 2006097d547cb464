"""What a simulation shows and an analysis says cannot be: a wrong bound, or a wrong simulation."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.chains import ChainResult
from amalthea_uros.analyze.results.processes import ProcessResult, RequirementResult
from amalthea_uros.errors import UnknownError
from amalthea_uros.judge.verdict import ObservedVerdict, Verdict
from amalthea_uros.simulate.observations import ChainObservation, ProcessObservation, RequirementObservation
from amalthea_uros.simulate.results import Simulation
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.timing.dataflow.chains import forks, unfold


def contradictions(analysis: Analysis, simulation: Simulation) -> Iterator[str]:
    """Where observations exceed the claims of an analysis, from the start of the run on."""
    yield from _crossed(analysis)
    observed = {process.name: process for process in simulation.processes}
    # A round begins when the one before has ended; the simulation plays jobs in its place, which wait for each other.
    rounds = analysis.solution.context.system.executor_of_task
    for process in analysis.processes:
        found = observed.get(process.name)
        if found is None or process.name in rounds:
            continue
        yield from _responses(process, found)
        yield from _metrics(process, found)
        if process.verdict is Verdict.MET and found.verdict is ObservedVerdict.MISSED:
            yield f"{process.name} is met, but observed as missed: {found.reason}"
    chains = {chain.name: chain for chain in simulation.chains}
    for chain in analysis.chains:
        # The simulation observes the ways through a chain one by one; of alternatives, the first one decides.
        if chain.name in chains and not _has_alternatives(analysis, chain.name):
            yield from _latencies(chain, chains[chain.name])
    missed = set(map(_identity, (item for item in simulation.requirements if item.verdict is ObservedVerdict.MISSED)))
    for requirement in analysis.requirements:
        if requirement.verdict is Verdict.MET and _identity(requirement) in missed:
            yield f"{requirement.name}, {requirement.quantity} of {requirement.object}, is met, but observed as missed"


def _has_alternatives(analysis: Analysis, chain: str) -> bool:
    system = analysis.solution.context.system
    try:
        unfolded, _ = unfold(system.chains[chain], system)
    except UnknownError:
        return False
    return any(fork.needed < len(fork.branches) for fork in forks(unfolded))


def _crossed(analysis: Analysis) -> Iterator[str]:
    """Minima above maxima, which no simulation is needed for."""
    for process in analysis.processes:
        response = process.response
        if response is not None and response.worst is not None and response.best > response.worst:
            yield f"response time of {process.name}: {response.best} at least, {response.worst} at most"
        for name, metric in process.metrics.items():
            if metric.min is not None and metric.max is not None and metric.min > metric.max:
                yield f"{name} of {process.name}: {metric.min} at least, {metric.max} at most"
    for chain in analysis.chains:
        values = {value.quantity.value: value.value for value in chain.values if value.value is not None}
        for least, most in (("min_first_to_first", "max_reduced_reaction_time"), ("min_last_to_last", "max_reduced_data_age")):
            if least in values and values[least] > values.get(most, values[least]):
                yield f"{chain.name}: {least} {values[least]} is above {most} {values[most]}"
        yield from (f"{chain.name}: {quantity} is negative, {value}" for quantity, value in values.items() if value < 0)


def _responses(process: ProcessResult, found: ProcessObservation) -> Iterator[str]:
    response, times = process.response, found.response_time
    if response is None:
        return
    longest = max(found.longest_unfinished, times.max if times else 0)
    if response.worst is not None and longest > response.worst:
        yield f"response time {longest} of {process.name} is beyond {response.worst} by {response.method}"
    if times is not None and times.min < response.best:
        yield f"response time {times.min} of {process.name} is below {response.best} by {response.method}"


def _metrics(process: ProcessResult, found: ProcessObservation) -> Iterator[str]:
    """Times of jobs beyond their bounds; those of responses are compared with the response itself."""
    for name, metric in process.metrics.items():
        times = found.metrics.get(name)
        if times is None or name is JobMetric.RESPONSE_TIME:
            continue
        if metric.max is not None and times.max > metric.max:
            yield f"{name} {times.max} of {process.name} is beyond {metric.max}"
        if metric.min is not None and times.min < metric.min:
            yield f"{name} {times.min} of {process.name} is below {metric.min}"


def _identity(requirement: RequirementResult | RequirementObservation) -> tuple[str, str, str, bool]:
    """What is limited; analysis and simulation have the same requirements."""
    return requirement.name, requirement.object, requirement.quantity, requirement.is_upper


def _latencies(chain: ChainResult, observed: ChainObservation) -> Iterator[str]:
    seen = {
        f"{side}_{quantity}": end
        for quantity, found in observed.quantities.items()
        for side, end in (("max", found.max), ("min", found.min))
    }
    for value in chain.all_values:
        found = seen.get(value.quantity.value)
        if value.value is None or found is None or value.quantity.is_mean:
            continue
        if found > value.value if value.quantity.is_upper else found < value.value:
            yield f"{value.quantity} {found} of {chain.name} is beyond {value.value} by {value.method}"
