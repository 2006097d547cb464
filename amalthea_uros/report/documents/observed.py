"""What a simulated run showed, beside the bounds of the analysis."""

from __future__ import annotations

from amalthea_uros._internal.plural import counted
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.report.basics.document import (
    Block,
    Cell,
    Section,
    Sentences,
    table,
)
from amalthea_uros.report.documents.simulation import REMINDER, duration_text
from amalthea_uros.report.documents.simulation import closing_line as observed_line
from amalthea_uros.report.wording.cells import at_most, badge, by_core_and_priority
from amalthea_uros.report.wording.cells import observed as observed_ends
from amalthea_uros.report.wording.chains import value_text
from amalthea_uros.services.report import ReportContent
from amalthea_uros.simulate.observations import ChainObservation, ProcessObservation
from amalthea_uros.simulate.results import Simulation
from amalthea_uros.timing.basics.quantities import ChainQuantity

#: The quantities of chains that are both computed and observed.
BOUNDED = {
    ChainQuantity.REDUCED_REACTION_TIME: LatencyQuantity.MAX_REDUCED_REACTION_TIME,
    ChainQuantity.REDUCED_DATA_AGE: LatencyQuantity.MAX_REDUCED_DATA_AGE,
}


def observed_section(content: ReportContent) -> Section | None:
    """Response times and latencies of a run beside their bounds."""
    if content.simulation is None:
        return None
    simulation = content.simulation.simulation
    blocks: list[Block] = [Sentences([_run(content, simulation), observed_line(simulation).removesuffix(REMINDER).rstrip()])]
    ordered = sorted(simulation.processes, key=lambda each: by_core_and_priority(each.core, each.is_isr, each.priority))
    titles = ("process", ">jobs", ">observed min", ">mean", ">max", ">worst case", ">lost", "observed verdict", "remark")
    if ordered:
        blocks.append(table("Response times: observed and worst case", titles, [_process(each, content) for each in ordered]))
    if simulation.chains:
        of_chains = ("chain", "latency", ">values", ">observed min", ">mean", ">max", ">worst case", "remark")
        rows = [row for chain in simulation.chains for row in _chain_of_observations(chain, content)]
        blocks.append(table("Latencies: observed and worst case", of_chains, rows))
    lead = "What one simulated run showed, beside the worst case of the analysis: observed values are typical, never a bound."
    return Section("observed", "Observed in a simulation", lead, blocks)


def _run(content: ReportContent, simulation: Simulation) -> str:
    chosen = ", chosen to limit the work (--duration sets another)" if content.is_duration_chosen else ""
    jobs = counted(sum(each.jobs for each in simulation.processes), "job")
    return f"Simulated: {duration_text(simulation.duration)}{chosen}, seed {simulation.seed}, mode {simulation.mode}: {jobs}."


def _process(process: ProcessObservation, content: ReportContent) -> tuple[Cell, ...]:
    response = content.analysis.processes[process.name].response
    return (
        process.name,
        f"{process.jobs:,}",
        *observed_ends(process.response_time),
        at_most(response.worst if response is not None else None, process.deadline),
        f"{process.lost_activations:,}",
        badge(process.verdict),
        process.reason,
    )


def _chain_of_observations(chain: ChainObservation, content: ReportContent) -> list[tuple[Cell, ...]]:
    result = content.analysis.chains[chain.name]
    rows: list[tuple[Cell, ...]] = []
    for observed, computed in BOUNDED.items():
        found = chain.quantities.get(observed)
        worst = value_text(result.value(computed)).replace("-", "unknown")
        count = f"{found.count:,}" if found is not None else "0"
        words = observed.removeprefix("reduced_").replace("_", " ")
        rows.append((chain.name, words, count, *observed_ends(found), worst, chain.reason))
    return rows
