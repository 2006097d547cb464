"""Executors that spin in loops, in tables: what they serve, when, and what can be lost."""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.executors.results import ExecutorResult, HandleResult
from amalthea_uros.report.message_chains import part_time
from amalthea_uros.report.terminal import Terminal
from amalthea_uros.units import Rounding, Time, rounded_time_text, time_text


def write_executors(terminal: Terminal, executors: Sequence[ExecutorResult]) -> None:
    """Write a table for each executor, with a row for each handle."""
    for executor in executors:
        terminal.heading(
            f"Executor {executor.name} (from the arrival of a message, or when a timer is due, to the end of the callback)"
        )
        if executor.reason:
            terminal.line(f"  {executor.reason}")
        else:
            terminal.line(
                f"  an iteration takes {_span(executor.round.least, executor.round.most)}, "
                f"from one wait to the next {_span(executor.loop.least, executor.loop.most)}"
            )
        headings = ("handle", "kind", "interval", "best", "worst", "late by", "can lose", "")
        terminal.table(headings, [_row(handle) for handle in executor.handles], right=(2, 3, 4, 5))
        for handle in executor.handles:
            if handle.lost is not None:
                terminal.line(
                    f"  {handle.name} {'loses' if handle.lost.is_certain else 'can lose'} {handle.lost.what}: {handle.lost.sequence}"
                )


def write_terms(terminal: Terminal, handle: HandleResult) -> None:
    """Write what the response time of a handle consists of, in the order of time."""
    if not handle.terms:
        return
    rows = [(term.name, part_time(term), _share(term.most or 0, handle), term.why) for term in handle.terms]
    terminal.table(("in the worst case", "time", "", ""), rows, right=(1, 2))


def _share(part: Time, handle: HandleResult) -> str:
    return f"{part / handle.response.worst:.1%}" if handle.response.worst else ""


def _row(handle: HandleResult) -> tuple[str, ...]:
    response, lateness = handle.response, handle.lateness
    return (
        handle.name,
        handle.kind.value,
        "?" if handle.interval is None else time_text(handle.interval),
        rounded_time_text(response.best, Rounding.DOWN),
        _time(response.worst, handle.interval),
        "-" if lateness is None else _time(lateness.most),
        "-" if handle.lost is None else handle.lost.what,
        response.reason or str(response.claim),
    )


def _span(least: Time, most: Time | None) -> str:
    return f"{rounded_time_text(least, Rounding.DOWN)} to {_time(most)}"


def _time(value: Time | None, limit: Time | None = None) -> str:
    return "?" if value is None else rounded_time_text(value, Rounding.UP, limit)
