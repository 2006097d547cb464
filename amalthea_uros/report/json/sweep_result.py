"""A sweep for programs."""

from __future__ import annotations

from typing import Any

from amalthea_uros.judge.summary import Schedulable
from amalthea_uros.report.findings import finding_json
from amalthea_uros.report.json import changes
from amalthea_uros.report.text.sweep_result import closing_line
from amalthea_uros.services.sweep import SweepResult


def content(result: SweepResult) -> dict[str, Any]:
    """All variants, each with its values and results."""
    return {
        "model": result.source,
        "findings": [finding_json(finding) for finding in result.findings],
        "changes": changes.content(result.differences),
        "sweeps": [{"key": f"{sweep.object}.{sweep.key}", "values": list(sweep.values)} for sweep in result.plan.sweeps],
        "combinations": result.plan.total,
        "seed": result.plan.seed,
        "planned_variants": len(result.plan.runs),
        "variants": result.rows,
        "summary": {
            "schedulable": len(result.schedulable),
            "not_schedulable": len(result.with_verdict(Schedulable.NO)),
            "unknown": len(result.with_verdict(Schedulable.UNKNOWN)),
            "failed": len(result.failed),
            "text": closing_line(result),
        },
    }
