"""Executors that spin in loops: the response time of each callback, what it consists of, and what can be lost."""

from __future__ import annotations

from amalthea_uros.executors.results import ExecutorResult, HandleResult
from amalthea_uros.report.html.blocks import Block, Cell, Folded, Section, Table, table
from amalthea_uros.report.html.times import at_least, at_most
from amalthea_uros.report.message_chains import part_time
from amalthea_uros.services.report import ReportContent
from amalthea_uros.units import time_text


def section(content: ReportContent) -> Section | None:
    """A table for each executor, and the terms of each response time."""
    executors = content.analysis.executors
    if not executors:
        return None
    blocks: list[Block] = []
    for executor in executors:
        blocks.append(_handles(executor))
        blocks += [_terms(handle) for handle in executor.handles if handle.terms]
    lead = "From the arrival of a message at the controller, or from when a timer is due, to the end of the callback."
    return Section("executors", "Executors", lead, blocks)


def _handles(executor: ExecutorResult) -> Table:
    titles = ("handle", "kind", ">interval", ">best", ">worst", ">late by", "claim", "what can be lost, and how", "why")
    return table(f"Executor {executor.name}", titles, [_row(handle) for handle in executor.handles])


def _row(handle: HandleResult) -> tuple[Cell, ...]:
    response, lateness = handle.response, handle.lateness
    return (
        handle.name,
        handle.kind.value,
        "unknown" if handle.interval is None else time_text(handle.interval),
        at_least(response.best),
        at_most(response.worst, handle.interval),
        "-" if lateness is None else at_most(lateness.most),
        str(response.claim),
        "-" if handle.lost is None else f"{handle.lost.what}: {handle.lost.sequence}",
        response.reason,
    )


def _terms(handle: HandleResult) -> Folded:
    rows = [(term.name, part_time(term), term.why) for term in handle.terms]
    terms = table(f"Worst response time of {handle.name}, in the order of time", ("part", ">time", "why"), rows)
    return Folded(f"What {handle.name} waits for", [terms])
