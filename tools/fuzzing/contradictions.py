"""What a simulation shows and an analysis says cannot be: a wrong bound, or a wrong simulation."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.analyze.results import Analysis, ChainResult, RequirementResult
from amalthea_uros.judge.verdict import ObservedVerdict, Verdict
from amalthea_uros.simulate.results import ChainObservation, RequirementObservation, Simulation


def contradictions(analysis: Analysis, simulation: Simulation) -> Iterator[str]:
    """Where observations exceed the claims of an analysis; minima are claimed for the steady state, and are not compared."""
    observed = {process.name: process for process in simulation.processes}
    # A round begins when the one before has ended; the simulation plays jobs in its place, which wait for each other.
    rounds = analysis.solution.context.system.executor_of_task
    for process in analysis.processes:
        found, response = observed.get(process.name), process.response
        if found is None or process.name in rounds:
            continue
        if response is not None and response.worst is not None:
            longest = max(found.longest_unfinished, found.response_time.max if found.response_time else 0)
            if longest > response.worst:
                yield f"response time {longest} of {process.name} is beyond {response.worst} by {response.method}"
        if process.verdict is Verdict.MET and found.verdict is ObservedVerdict.MISSED:
            yield f"{process.name} is met, but observed as missed: {found.reason}"
    chains = {chain.name: chain for chain in simulation.chains}
    for chain in analysis.chains:
        if chain.name in chains:
            yield from _latencies(chain, chains[chain.name])
    missed = set(map(_identity, (item for item in simulation.requirements if item.verdict is ObservedVerdict.MISSED)))
    for requirement in analysis.requirements:
        if requirement.verdict is Verdict.MET and _identity(requirement) in missed:
            yield f"{requirement.name}, {requirement.quantity} of {requirement.object}, is met, but observed as missed"


def _identity(requirement: RequirementResult | RequirementObservation) -> tuple[str, str, str, bool]:
    """What is limited; analysis and simulation have the same requirements."""
    return requirement.name, requirement.object, requirement.quantity, requirement.is_upper


def _latencies(chain: ChainResult, observed: ChainObservation) -> Iterator[str]:
    seen = {f"max_{quantity}": found.max for quantity, found in observed.quantities.items()}
    for value in chain.all_values:
        longest = seen.get(value.quantity)
        if value.value is not None and longest is not None and longest > value.value:
            yield f"{value.quantity} {longest} of {chain.name} is beyond {value.value} by {value.method}"
