"""Values that were lost in a measurement."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from amalthea_uros.compare.naming import Target
from amalthea_uros.compare.results import LossRow
from amalthea_uros.measure.series import MeasuredKind
from amalthea_uros.simulate.results import Simulation


def losses(targets: Sequence[Target], simulation: Simulation | None) -> Iterator[LossRow]:
    """The quantities of which values were lost, those of an object once."""
    seen: set[str] = set()
    for target in targets:
        lost, statistics = target.series.counts.lost, target.series.statistics
        if lost and target.name not in seen and not target.is_unknown:
            seen.add(target.name)
            values = 0 if statistics is None else statistics.count
            simulated = _share_unanswered(target, simulation)
            yield LossRow(
                object=target.name, kind=target.kind, quantity=target.quantity, values=values, lost=lost, simulated=simulated
            )


def _share_unanswered(target: Target, simulation: Simulation | None) -> Fraction | None:
    if simulation is None or target.kind is not MeasuredKind.CHAIN:
        return None
    chain = next((each for each in simulation.chains if each.name == target.name), None)
    stimuli = 0 if chain is None else sum(route.stimuli for route in chain.routes)
    return None if chain is None or not stimuli else Fraction(chain.unanswered, stimuli)
