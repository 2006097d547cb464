"""The executors of a host: their threads, and their callbacks with bounds, beside what a simulated run showed."""

from __future__ import annotations

from amalthea_uros.executors.results import HandleResult
from amalthea_uros.perf.host import HostExecutor, HostPolicy
from amalthea_uros.report.basics.document import Block, Cell, Section, Sentences, Table, table
from amalthea_uros.report.documents.analysis import HOST_COLUMNS, host_row
from amalthea_uros.report.wording.cells import load_text
from amalthea_uros.report.wording.cells import observed as observed_ends
from amalthea_uros.services.report import ReportContent
from amalthea_uros.simulate.observations import HandleObservation
from amalthea_uros.simulate.program.host_system import host_cores
from amalthea_uros.simulate.results import Simulation
from amalthea_uros.units import time_text

#: The columns of bounds, and before the last two those of a run.
_COLUMNS = (*HOST_COLUMNS[:5], ">observed calls", ">observed max", ">observed lost", *HOST_COLUMNS[5:])


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
        blocks.append(table(f"Executor {result.name} of the host", _COLUMNS, rows))
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
