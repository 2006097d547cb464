"""A campaign for programs."""

from __future__ import annotations

from typing import Any

from amalthea_uros.report.findings import finding_json, joined
from amalthea_uros.report.json import changes
from amalthea_uros.report.text.campaign_result import closing_line
from amalthea_uros.services.simulate import CampaignResult


def content(result: CampaignResult) -> dict[str, Any]:
    """All runs, each with its values."""
    return {
        "model": joined(result.paths),
        "findings": [finding_json(finding) for finding in result.findings],
        "duration_ps": result.options.duration,
        "mode": result.options.mode,
        "changes": changes.content(result.differences),
        "planned_runs": result.planned,
        "runs": result.rows,
        "summary": {
            "missed": len(result.missed),
            "failed": len(result.failed),
            "incomplete": len(result.incomplete),
            "not_observed": len(result.not_observed),
            "text": closing_line(result),
        },
    }
