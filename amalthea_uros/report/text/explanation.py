"""The response time of one process for people."""

from __future__ import annotations

from amalthea_uros.report.terminal import Terminal
from amalthea_uros.services.analyze import Explanation
from amalthea_uros.units import time_text


def write(explanation: Explanation, terminal: Terminal) -> None:
    """Write the terms of a response time, and whose jobs interfere."""
    process, shares = explanation.process, explanation.shares
    response, name = process.response, terminal.style(process.name, "1")
    if response is None:
        terminal.line(f"{name}: response time unknown: {process.reason}")
        return
    if response.worst is None:
        terminal.line(f"{name}: response time unbounded: {response.reason}")
        return
    terminal.line(f"{name}: worst-case response time {time_text(response.worst)} ({response.claim})")
    terms = [(term, time_text(value)) for term, value in response.terms.items() if value]
    terminal.table(("made of", ""), [*terms, ("sum", time_text(response.worst))], right=(1,))
    if shares:
        rows = [(share.name, share.jobs, time_text(share.time)) for share in shares]
        terminal.table(("interference by", "jobs", "time"), rows, right=(1, 2))
    terminal.line(f"  {response.method} ({response.source}), {response.jobs} jobs examined")
