"""Findings for programs."""

from __future__ import annotations

from typing import Any

from amalthea_uros.findings.fingerprint import fingerprint
from amalthea_uros.report.findings import finding_json, joined, profile_name
from amalthea_uros.services.check import CheckResult


def content(result: CheckResult) -> dict[str, Any]:
    """All findings, with the profiles of their rules and the findings under which they are shown."""
    return {
        "model": joined(result.paths),
        "assumptions": [],
        "findings": [
            {
                **finding_json(finding),
                "profile": profile_name(finding.rule),
                "fingerprint": fingerprint(finding),
                "part_of": part_of,
                "counts": counts,
            }
            for finding, part_of, counts in result.presentation.entries()
        ],
    }
