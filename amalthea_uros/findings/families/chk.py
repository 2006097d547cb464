"""Findings about the rules themselves."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

KINDS = (
    FindingKind(
        id="CHK001",
        title="rule that failed at an object",
        severity=Severity.ERROR,
        rationale="The rule has a defect, and problems that it would report for this object are not reported.",
        remedy="Report the defect to the author of the rule, with the model if possible.",
    ),
)
