"""Gantt charts of the worst that the simulation observed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

from amalthea_uros._internal.plural import counted
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.report.html.blocks import Block, Figure, Folded, Section, Sentences
from amalthea_uros.report.judged import worst_chains
from amalthea_uros.report.simulation_pictures import gantt_picture
from amalthea_uros.services.report import ReportContent

#: Chains whose ways are drawn, rows of a chart, and charts that are seen at once.
_MOST_CHAINS, _MOST_ROWS, _SHOWN = 3, 40, 2


def section(content: ReportContent) -> Section | None:
    """Around the job that came closest to its deadline, and around the longest latency of the worst chains."""
    if content.simulation is None or not any(each.response_time for each in content.simulation.simulation.processes):
        return None
    charts: list[Block] = []
    missing: list[str] = []
    for number, draw in enumerate(_charts(content)):
        try:
            charts.append(Figure(f"gantt-{number}", draw()))
        except InvalidArgumentError as error:
            missing.append(f"Not drawn: {error}.")
    blocks = charts[:_SHOWN]
    if charts[_SHOWN:]:
        blocks.append(Folded(counted(len(charts[_SHOWN:]), "more chart"), charts[_SHOWN:]))
    if missing:
        blocks.append(Sentences(missing))
    lead = "What each task does around the longest observed times; a line from task to task is the way of a chain's effect."
    return Section("worst-observed", "Worst observed cases", lead, blocks)


def _charts(content: ReportContent) -> Iterator[Callable[[], str]]:
    assert content.simulation is not None
    yield partial(gantt_picture, content.simulation, most_rows=_MOST_ROWS)
    observed = [
        chain for chain in worst_chains(content.analysis) if content.simulation.simulation.chains[chain.name].quantities
    ]
    for chain in observed[:_MOST_CHAINS]:
        yield partial(gantt_picture, content.simulation, chain=chain.name, most_rows=_MOST_ROWS)
