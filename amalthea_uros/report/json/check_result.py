"""Findings for programs."""

from __future__ import annotations

from typing import Any

from amalthea_uros.report.findings import finding_json, joined, profile_name
from amalthea_uros.services.check import CheckResult


def content(result: CheckResult) -> dict[str, Any]:
    """All findings, with the profiles of their rules."""
    return {
        "model": joined(result.paths),
        "assumptions": [],
        "findings": [{**finding_json(finding), "profile": profile_name(finding.rule)} for finding in result.findings],
    }
