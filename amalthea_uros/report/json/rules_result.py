"""A list of rules for programs."""

from __future__ import annotations

from typing import Any

from amalthea_uros.report.findings import profile_name
from amalthea_uros.services.rules import RulesResult


def content(result: RulesResult) -> dict[str, Any]:
    """What each rule reports, why that matters, and what to do."""
    return {
        "rules": [
            {
                "id": rule.id,
                "severity": rule.severity,
                "profile": profile_name(rule.id),
                "title": rule.title,
                "rationale": rule.rationale,
                "remedy": rule.remedy,
            }
            for rule in result.rules
        ]
    }
