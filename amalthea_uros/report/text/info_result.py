"""The summary of a model for people."""

from __future__ import annotations

from amalthea_uros._internal.plural import counted
from amalthea_uros.metamodel.summary import ModelSummary
from amalthea_uros.metamodel.versions import spelled
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.info import InfoResult

#: More classes and memories are only counted: the rare ones hide what matters.
MOST_CLASSES = 12
MOST_MEMORIES = 6


def write(result: InfoResult, terminal: Terminal) -> None:
    """Write tables of documents, cores, processes, chains and classes."""
    summary = result.summary
    for document in summary.documents:
        size = f", {document.characters / 1000:,.1f} kB" if document.characters else ", built in memory"
        size += ", zipped" if document.compressed else ""
        path = terminal.style(document.path, "1")
        version = spelled(document.version)
        if document.migrated_from is not None:
            version = f"{spelled(document.migrated_from)}, migrated to {document.version} in memory"
        terminal.line(f"{path}: {version}, {counted(document.objects, 'object')}{size}")
    if summary.unresolved:
        terminal.line(f"  {counted(summary.unresolved, 'unresolved reference')}")
    _cores(terminal, summary)
    _processes(terminal, summary)
    _chains(terminal, summary)
    _counts(terminal, summary)


def _cores(terminal: Terminal, summary: ModelSummary) -> None:
    if not summary.cores:
        return
    shown = ", ".join(summary.memories[:MOST_MEMORIES])
    more = f" and {len(summary.memories) - MOST_MEMORIES} more" if len(summary.memories) > MOST_MEMORIES else ""
    memories = f", memories ({len(summary.memories)}): {shown}{more}" if summary.memories else ""
    terminal.heading(f"Cores ({len(summary.cores)}){memories}")
    rows = [(c.name, c.structure, c.definition, c.frequency, ", ".join(c.schedulers) or "-") for c in summary.cores]
    terminal.table(("core", "in", "type", "clock", "schedulers"), rows, right=(3,))


def _processes(terminal: Terminal, summary: ModelSummary) -> None:
    if not summary.processes:
        return
    tasks = sum(process.kind == "task" for process in summary.processes)
    terminal.heading(f"Tasks ({tasks}) and ISRs ({len(summary.processes) - tasks})")
    rows = [
        (
            p.name,
            p.kind,
            "; ".join(p.stimuli) or "-",
            p.priority or "-",
            p.preemption or "-",
            p.scheduler or "-",
            p.runnable_calls,
        )
        for p in summary.processes
    ]
    headings = ("name", "kind", "activated", "priority", "preemption", "scheduler", "calls")
    terminal.table(headings, rows, right=(3, 6))


def _chains(terminal: Terminal, summary: ModelSummary) -> None:
    if not summary.chains:
        return
    terminal.heading(f"Event chains ({len(summary.chains)})")
    rows = [(c.name, c.stimulus or "-", c.response or "-", c.items) for c in summary.chains]
    terminal.table(("name", "from", "to", "items"), rows, right=(3,))


def _counts(terminal: Terminal, summary: ModelSummary) -> None:
    terminal.heading(f"Objects ({sum(summary.counts.values()):,} of {counted(len(summary.counts), 'class')})")
    shown = list(summary.counts.items())
    rest = shown[MOST_CLASSES:] if len(shown) > MOST_CLASSES + 1 else []
    rows = [(f"{count:,}", name) for name, count in shown[: len(shown) - len(rest)]]
    if rest:
        rows.append((f"{sum(count for _, count in rest):,}", f"of {len(rest)} more classes"))
    terminal.table(("count", "class"), rows, right=(0,))
