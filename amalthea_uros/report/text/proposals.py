"""Proposed priorities for people."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.analyze.priorities.assignment import Proposal, ProposalOutcome
from amalthea_uros.report.terminal import Terminal


def write_proposals(terminal: Terminal, proposals: Iterable[Proposal]) -> None:
    """Write a table for each core."""
    for proposal in proposals:
        _proposal(terminal, proposal)


def _proposal(terminal: Terminal, proposal: Proposal) -> None:
    terminal.heading(f"Priorities on {proposal.core}")
    if proposal.outcome is ProposalOutcome.KEPT:
        terminal.line("  the present priorities meet all deadlines")
        return
    if proposal.priorities is None:
        terminal.line(f"  no proposal: {proposal.reason}")
        return
    ordered = sorted(proposal.priorities.items(), key=lambda item: -item[1])
    rows = [(name, "?" if (now := proposal.current[name]) is None else str(now), str(to)) for name, to in ordered]
    terminal.table(("task", "now", "proposed"), rows, right=(1, 2))
