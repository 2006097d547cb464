"""Findings of reading the settings of a project."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

KINDS = (
    FindingKind(
        id="CFG001",
        title="settings that cannot be read",
        severity=Severity.ERROR,
        rationale="The settings are not valid TOML, not UTF-8, or larger than 1 MiB; nothing is checked without them.",
        remedy="Correct the syntax of pyproject.toml or amuros.toml.",
        fails="""
[check
""",
    ),
    FindingKind(
        id="CFG002",
        title="unknown setting, or setting with a wrong value",
        severity=Severity.ERROR,
        rationale="A setting that is not understood would have no effect, so it is refused.",
        remedy="Correct the setting; see docs/check.md for all of them.",
        fails="""
[check]
fail-on = "never"
""",
    ),
)
