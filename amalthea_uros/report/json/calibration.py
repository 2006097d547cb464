"""A calibration for programs; times are whole picoseconds."""

from __future__ import annotations

from typing import Any

from amalthea_uros.compare.calibration.values import CalibratedValue
from amalthea_uros.report.findings import finding_json
from amalthea_uros.services.calibrate import Calibration


def content(calibration: Calibration) -> dict[str, Any]:
    """All measured values, and what became of them."""
    options = calibration.options
    return {
        "description": str(calibration.path),
        "traces": list(calibration.sources),
        "form": options.form,
        "margin": float(options.margin),
        "tighten": options.tighten,
        "judge_on": float(options.judge_on),
        "values": [value_json(value) for value in calibration.values],
        "refuted": sum(bool(value.refuted) for value in calibration.values),
        "changed": calibration.change.after != calibration.change.before,
        "findings": [finding_json(finding) for finding in calibration.findings],
    }


def value_json(value: CalibratedValue) -> dict[str, Any]:
    """A measured value."""
    return {
        "target": value.target,
        "measured": ", ".join(value.measured),
        "quantity": value.quantity,
        "traces": ", ".join(value.sources),
        "samples": value.statistics.count,
        "min_ps": value.statistics.min,
        "avg_ps": round(value.statistics.mean),
        "max_ps": value.statistics.max,
        "line": value.line,
        "from": value.before,
        "to": value.after,
        "outcome": value.outcome,
        "refuted": ", ".join(value.refuted),
        "judged": value.held_out,
        "outside": value.outside,
        "reason": value.reason,
    }
