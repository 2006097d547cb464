"""What the reading of a system has to report: assumptions, and what is not taken into account."""

from __future__ import annotations

from dataclasses import dataclass, field

from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.perf.named import Named


class UnknownDemandError(Exception):
    """The execution demand of a process is unknown; the text says why."""


@dataclass(slots=True)
class Notes:
    """Collects findings and assumptions, each of them once."""

    found: dict[Finding, None] = field(default_factory=dict)
    assumptions: dict[str, None] = field(default_factory=dict)

    def warning(self, rule: str, message: str, item: Named | None) -> None:
        """Add a finding about something that cannot be taken into account as it is."""
        name = item.name if item else ""
        self.found[Finding(rule, Severity.WARNING, message, item.origin if item else None, object=name)] = None

    def assume(self, sentence: str) -> None:
        """Add an assumption on which the results rest."""
        self.assumptions[sentence] = None
