"""Findings of loading user-made rules."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

KINDS = (
    FindingKind(
        id="RUL001",
        title="rules that cannot be loaded",
        severity=Severity.ERROR,
        rationale="The file of --rules, or an installed package with rules, has an error, so that its rules cannot be run.",
        remedy="Correct the file at the given line, or update the package.",
    ),
    FindingKind(
        id="RUL002",
        title="unusable id of a rule",
        severity=Severity.ERROR,
        rationale="An id that another rule or finding has would be ambiguous, and one with blanks or commas cannot be selected.",
        remedy="Give the rule an id of its own, for example with the name of the project: ACME-001.",
    ),
)
