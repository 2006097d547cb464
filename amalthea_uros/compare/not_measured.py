"""What a measurement does not have: values that were lost, and objects of the model that were not measured."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from amalthea_uros.compare.naming import Target
from amalthea_uros.compare.results import Agreement, ComparisonRow, LossRow
from amalthea_uros.measure.begins import ModelBegins
from amalthea_uros.measure.series import MeasuredKind
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.results import Simulation

_NOT_IN_TRACE = {
    MeasuredKind.PROCESS: "the trace has no process of this name",
    MeasuredKind.CHAIN: "the trace has no values of this chain",
    MeasuredKind.RUNNABLE: "the trace has no call of this callback",
}


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


def not_measured(system: System, targets: Sequence[Target], begins: ModelBegins) -> Iterator[ComparisonRow]:
    """A row for each process, chain, and callback of a host of which the trace has nothing, or nothing of the same definition."""
    measured = {(target.kind, target.name) for target in targets}
    of_host = [callback.name for callback in system.host.callbacks]
    kinds = {MeasuredKind.PROCESS: system.processes, MeasuredKind.CHAIN: system.chains, MeasuredKind.RUNNABLE: of_host}
    for kind, names in kinds.items():
        for name in names:
            if (kind, name) not in measured:
                yield ComparisonRow(
                    object=name,
                    kind=kind,
                    quantity="",
                    statistic=None,
                    verdict=Agreement.NOT_MEASURED,
                    reason=_not_in_trace(kind, name, begins),
                )


def _not_in_trace(kind: MeasuredKind, name: str, begins: ModelBegins) -> str:
    begin = begins.chains.get(name) if kind is MeasuredKind.CHAIN else None
    return begin if isinstance(begin, str) else _NOT_IN_TRACE[kind]
