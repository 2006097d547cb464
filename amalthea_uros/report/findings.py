"""Findings for programs."""

from __future__ import annotations

from typing import Any

from amalthea_uros.diagnostics import Finding


def finding_json(finding: Finding) -> dict[str, Any]:
    """A finding for programs."""
    place = finding.location
    return {
        "rule": finding.rule,
        "severity": finding.severity,
        "message": finding.message,
        "help": finding.help,
        "file": str(place.path) if place else None,
        "line": place.line if place else None,
        "column": place.column if place else None,
        "object": finding.object,
    }
