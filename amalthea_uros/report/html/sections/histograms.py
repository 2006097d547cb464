"""Histograms of the observed latencies and response times, with bounds and limits."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.analyze.results import ProcessResult, Quantity
from amalthea_uros.report.html.blocks import Figure, Section
from amalthea_uros.report.judged import judged_rows, requirements_of, worst_chains
from amalthea_uros.report.pictures.histogram_marks import Mark, MarkKind
from amalthea_uros.report.simulation_pictures import histogram_picture
from amalthea_uros.services.report import ReportContent
from amalthea_uros.simulate.results import ChainQuantity

_MOST_CHAINS, _MOST_PROCESSES = 3, 3


def section(content: ReportContent) -> Section | None:
    """Those of the worst chains and of the tightest tasks."""
    if content.simulation is None:
        return None
    figures = [
        Figure(f"histogram-{number}", picture) for number, picture in enumerate((*_chains(content), *_processes(content)))
    ]
    lead = "How often each time was observed; the bound of the analysis is never exceeded, the limit must not be."
    return Section("histograms", "Distributions of observed times", lead, figures) if figures else None


def _chains(content: ReportContent) -> Iterator[str]:
    assert content.simulation is not None
    observed = content.simulation.simulation.chains
    chains = [
        each for each in worst_chains(content.analysis) if ChainQuantity.REDUCED_REACTION_TIME in observed[each.name].quantities
    ]
    for chain in chains[:_MOST_CHAINS]:
        marks = [
            Mark("limit", each.limit, MarkKind.LIMIT)
            for each in requirements_of(chain.name, content.analysis)
            if each.quantity == "reaction" and each.is_upper and each.limit is not None
        ]
        value = chain.value(Quantity.MAX_REDUCED_REACTION_TIME)
        if value is not None and value.value is not None:
            marks.append(Mark("worst case", value.value, MarkKind.BOUND))
        name = f"{chain.name}.{ChainQuantity.REDUCED_REACTION_TIME}"
        yield histogram_picture(content.simulation, name, marks)


def _processes(content: ReportContent) -> Iterator[str]:
    assert content.simulation is not None
    simulated = content.simulation.simulation.processes
    names = [row.item.name if isinstance(row.item, ProcessResult) else row.item.object for row in judged_rows(content.analysis)]
    found = [name for name in dict.fromkeys(names) if name in content.system.processes]
    for name in [name for name in found if simulated[name].response_time is not None][:_MOST_PROCESSES]:
        response = content.analysis.processes[name].response
        worst = response.worst if response is not None else None
        marks = [] if worst is None else [Mark("worst case", worst, MarkKind.BOUND)]
        yield histogram_picture(content.simulation, f"{name}.response_time", marks)
