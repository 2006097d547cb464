"""Histograms of the observed latencies and response times, with bounds and limits."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.analyze.results.processes import ProcessResult
from amalthea_uros.report.html.blocks import Block, Figure, Folded, Section, Sentences
from amalthea_uros.report.html.times import at_least, at_most
from amalthea_uros.report.judged import judged_rows, requirements_of, worst_chains
from amalthea_uros.report.pictures.histogram_marks import Mark, MarkKind
from amalthea_uros.report.simulation_pictures import histogram_picture
from amalthea_uros.services.report import ReportContent
from amalthea_uros.services.simulate import SimulationResult
from amalthea_uros.simulate.observations import MetricObservation
from amalthea_uros.timing.basics.quantities import ChainQuantity, JobMetric

_MOST_CHAINS, _MOST_PROCESSES = 3, 3


@dataclass(frozen=True, slots=True)
class _Distribution:
    """Observed values of a process or chain, and what they are compared with."""

    of: str
    quantity: str
    observed: MetricObservation
    marks: Sequence[Mark]


def section(content: ReportContent) -> Section | None:
    """Those of the worst chains; those of the tightest tasks are folded if there are chains."""
    if content.simulation is None:
        return None
    simulation = content.simulation
    chains = [_block(simulation, each, f"histogram-{number}") for number, each in enumerate(_chains(content))]
    tasks = [_block(simulation, each, f"histogram-of-task-{number}") for number, each in enumerate(_processes(content))]
    title = "Response times of the tasks that are closest to their limits"
    blocks = [*chains, Folded(title, tasks)] if chains and tasks else [*chains, *tasks]
    lead = "How often each time was observed; the bound of the analysis is never exceeded, the limit must not be."
    return Section("histograms", "Distributions of observed times", lead, blocks) if blocks else None


def _block(simulation: SimulationResult, shown: _Distribution, name: str) -> Block:
    """A histogram; a sentence for values that are all in the same bin."""
    observed = shown.observed
    if observed.histogram is not None and sum(count > 0 for count in observed.histogram.counts) > 1:
        return Figure(name, histogram_picture(simulation, f"{shown.of}.{shown.quantity}", shown.marks))
    least, most = at_least(observed.min), at_most(observed.max)
    values = least if least == most else f"{least} to {most}"
    return Sentences(
        [f"The {shown.quantity.replace('_', ' ')} of {shown.of} was {values} in all {observed.count:,} observations."]
    )


def _chains(content: ReportContent) -> Iterator[_Distribution]:
    assert content.simulation is not None
    quantity = ChainQuantity.REDUCED_REACTION_TIME
    observed = content.simulation.simulation.chains
    chains = [each for each in worst_chains(content.analysis) if quantity in observed[each.name].quantities]
    for chain in chains[:_MOST_CHAINS]:
        marks = [
            Mark("limit", each.limit, MarkKind.LIMIT)
            for each in requirements_of(chain.name, content.analysis)
            if each.quantity == "reaction" and each.is_upper and each.limit is not None
        ]
        value = chain.value(LatencyQuantity.MAX_REDUCED_REACTION_TIME)
        if value is not None and value.value is not None:
            marks.append(Mark("worst case", value.value, MarkKind.BOUND))
        yield _Distribution(chain.name, quantity, observed[chain.name].quantities[quantity], marks)


def _processes(content: ReportContent) -> Iterator[_Distribution]:
    assert content.simulation is not None
    # Without those that are not simulated.
    simulated = {each.name: each for each in content.simulation.simulation.processes}
    names = [row.item.name if isinstance(row.item, ProcessResult) else row.item.object for row in judged_rows(content.analysis)]
    found = [simulated[name] for name in dict.fromkeys(names) if name in simulated]
    for each in [each for each in found if each.response_time is not None][:_MOST_PROCESSES]:
        assert each.response_time is not None
        response = content.analysis.processes[each.name].response
        worst = response.worst if response is not None else None
        marks = [] if worst is None else [Mark("worst case", worst, MarkKind.BOUND)]
        yield _Distribution(each.name, JobMetric.RESPONSE_TIME, each.response_time, marks)
