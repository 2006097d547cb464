"""What a simulated run showed, beside the bounds of the analysis, and the executors of a host with both."""

from __future__ import annotations

from amalthea_uros._internal.plural import counted
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.executors.results import HandleResult
from amalthea_uros.perf.host import HostExecutor, HostPolicy
from amalthea_uros.report.basics.document import Block, Cell, Section, Sentences, Table, table
from amalthea_uros.report.documents.analysis import HOST_COLUMNS, host_row
from amalthea_uros.report.documents.simulation import REMINDER, duration_text
from amalthea_uros.report.documents.simulation import closing_line as observed_line
from amalthea_uros.report.wording.cells import at_most, badge, by_core_and_priority, load_text
from amalthea_uros.report.wording.cells import observed as observed_ends
from amalthea_uros.report.wording.chains import value_text
from amalthea_uros.services.report import ReportContent
from amalthea_uros.simulate.observations import ChainObservation, HandleObservation, ProcessObservation
from amalthea_uros.simulate.program.host_system import host_cores
from amalthea_uros.simulate.results import Simulation
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.units import time_text

#: The quantities of chains that are both computed and observed.
BOUNDED = {
    ChainQuantity.REDUCED_REACTION_TIME: LatencyQuantity.MAX_REDUCED_REACTION_TIME,
    ChainQuantity.REDUCED_DATA_AGE: LatencyQuantity.MAX_REDUCED_DATA_AGE,
}

#: The columns of bounds, and before the last two those of a run.
_HOST_COLUMNS = (*HOST_COLUMNS[:5], ">observed calls", ">observed max", ">observed lost", *HOST_COLUMNS[5:])


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


# The host.


def host_section(content: ReportContent) -> Section | None:
    """The threads of all executors, and a table for each executor; bounds and observed values stand side by side."""
    executors, simulation = content.system.host.executors, content.simulation.simulation if content.simulation else None
    if not executors:
        return None
    seen = {handle.name: handle for each in simulation.host for handle in each.handles} if simulation is not None else {}
    blocks: list[Block] = [_threads(content, simulation)]
    for result in content.analysis.host:
        blocks.append(Sentences([f"{result.name}: {result.reason}"] if result.reason else []))
        rows = [_observed_row(handle, seen.get(handle.name)) for handle in result.handles]
        blocks.append(table(f"Executor {result.name} of the host", _HOST_COLUMNS, rows))
    lead = (
        "From the arrival of a message, or from when a timer is due, to the end of the callback; observed values are no bounds."
    )
    return Section("host", "Executors of the host", lead, blocks)


def _threads(content: ReportContent, simulation: Simulation | None) -> Table:
    columns = ("executor", "class", ">threads", "scheduling", "cores", "observed load of the cores")
    host = content.system.host
    rows: list[tuple[Cell, ...]] = []
    for executor in host.executors:
        names = host_cores(executor, host)
        loads = [simulation.cores[name] for name in names if name in simulation.cores.names] if simulation is not None else []
        shown = ", ".join(load_text(each.load) for each in loads) or "-"
        cores = ", ".join(name.partition("/")[2] for name in names)
        rows.append((executor.name, executor.kind.value, f"{executor.threads:,}", _scheduling(executor), cores, shown))
    return table("Threads of the executors", columns, rows)


def _scheduling(executor: HostExecutor) -> str:
    thread = executor.thread
    if thread.policy is HostPolicy.DEADLINE:
        return f"deadline: {time_text(thread.budget)} every {time_text(thread.period)}"
    return f"fifo, priority {thread.priority}" if thread.policy is HostPolicy.FIFO else thread.policy.value


def _observed_row(handle: HandleResult, seen: HandleObservation | None) -> tuple[Cell, ...]:
    *first, lost, method = host_row(handle)
    if seen is None:
        return (*first, "-", "-", "-", lost, method)
    return (*first, f"{seen.calls:,}", observed_ends(seen.response_time)[2], f"{seen.lost:,}", lost, method)
