"""What a change of a system does to what is observed in a simulation."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import TYPE_CHECKING

from amalthea_uros.analyze.impact import ComparedFigure, FigureUnit, Impact, Preference, ResultPart, compare, verdict_figure
from amalthea_uros.judge.verdict import ObservedVerdict
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.timing.response import Claim

if TYPE_CHECKING:
    from amalthea_uros.simulate.observations import ChainObservation, ProcessObservation, RequirementObservation
    from amalthea_uros.simulate.results import Simulation


def observed_impact(before: Simulation, after: Simulation) -> Impact:
    """Compare two runs, object by object."""
    return compare(_figures(before), _figures(after))


def _figures(simulation: Simulation) -> Iterator[ComparedFigure]:
    for core in simulation.cores:
        yield _figure(ResultPart.CORE, core.name, "load", core.load, unit=FigureUnit.SHARE)
    for process in simulation.processes:
        yield from _of_process(process)
    for chain in simulation.chains:
        yield from _of_chain(chain)
    for requirement in simulation.requirements:
        yield from _of_requirement(requirement)


def _figure(
    part: ResultPart,
    name: str,
    quantity: str,
    value: Fraction | None,
    goal: Preference = Preference.LOW,
    unit: FigureUnit = FigureUnit.TIME,
    reason: str = "",
) -> ComparedFigure:
    claim = None if value is None else Claim.OBSERVED
    return ComparedFigure(
        part=part, object=name, quantity=quantity, value=value, unit=unit, goal=goal, claim=claim, reason=reason
    )


def _of_process(process: ProcessObservation) -> Iterator[ComparedFigure]:
    found = process.response_time
    longest = None if found is None else found.max
    yield _figure(ResultPart.PROCESS, process.name, "max_response_time", longest, reason=process.reason)
    if process.deadline is not None:
        yield ComparedFigure(part=ResultPart.PROCESS, object=process.name, quantity="deadline", value=process.deadline)
    yield verdict_figure(ResultPart.PROCESS, process.name, process.verdict, process.reason)
    lost = Fraction(process.lost_activations)
    yield _figure(ResultPart.PROCESS, process.name, "lost_activations", lost, unit=FigureUnit.NUMBER)


def _of_chain(chain: ChainObservation) -> Iterator[ComparedFigure]:
    reaction, age = (
        chain.quantities.get(quantity) for quantity in (ChainQuantity.REDUCED_REACTION_TIME, ChainQuantity.REDUCED_DATA_AGE)
    )
    least, most = (None, None) if reaction is None else (reaction.min, reaction.max)
    yield _figure(ResultPart.CHAIN, chain.name, "min_first_to_first", least, Preference.NONE, reason=chain.reason)
    yield _figure(ResultPart.CHAIN, chain.name, "max_reduced_reaction_time", most, reason=chain.reason)
    yield _figure(ResultPart.CHAIN, chain.name, "max_reduced_data_age", None if age is None else age.max, reason=chain.reason)


def _of_requirement(requirement: RequirementObservation) -> Iterator[ComparedFigure]:
    name = requirement.name
    margin = None if requirement.verdict is ObservedVerdict.NOT_OBSERVED else requirement.margin
    unit = FigureUnit.TIME if requirement.is_time else FigureUnit.NUMBER
    yield _figure(ResultPart.REQUIREMENT, name, "margin", margin, Preference.HIGH, unit, requirement.reason)
    yield verdict_figure(ResultPart.REQUIREMENT, name, requirement.verdict, requirement.reason)
