"""Findings and assumptions of the timing context."""

from __future__ import annotations

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.perf.named import Named


@dataclass(slots=True)
class AnalysisNotes:
    """Collects findings and assumptions, each of them once."""

    found: dict[Finding, None] = field(default_factory=dict)
    assumptions: dict[str, None] = field(default_factory=dict)

    def warning(self, rule: str, message: str, item: Named | None) -> None:
        """Add a finding about something that is not analysed as modelled."""
        self._add(rule, Severity.WARNING, message, item)

    def error(self, rule: str, message: str, item: Named | None) -> None:
        """Add a finding about something whose analysis failed."""
        self._add(rule, Severity.ERROR, message, item)

    def _add(self, rule: str, severity: Severity, message: str, item: Named | None) -> None:
        name = item.name if item else ""
        self.found[Finding(rule, severity, message, item.origin if item else None, object=name)] = None

    def assume(self, sentence: str) -> None:
        """Add an assumption on which the results are based."""
        self.assumptions[sentence] = None

    def include(self, others: AnalysisNotes) -> None:
        """Add the findings and assumptions of another context, on which results of this one are based, too."""
        self.found.update(others.found)
        self.assumptions.update(others.assumptions)
