"""Findings of building an AMALTHEA model."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

KINDS = (
    FindingKind(
        id="BLD001",
        title="system that cannot be built",
        severity=Severity.ERROR,
        rationale="A name is not defined, or the AMALTHEA version has no element or literal for the object.",
        remedy="Define the name, or choose a newer version with --amalthea.",
    ),
)
