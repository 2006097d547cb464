"""A comparison with a measurement for programs: times are rounded to the nearest picosecond."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from amalthea_uros.compare.results import (
    Agreement,
    Comparison,
    ComparisonRow,
    DistributionRow,
    MeasuredLimit,
)
from amalthea_uros.report.compared import closing_line
from amalthea_uros.report.findings import finding_json
from amalthea_uros.report.json import changes


def content(result: Comparison) -> dict[str, Any]:
    """Everything that was compared."""
    measurement = result.measurement
    return {
        "model": result.model,
        "trace": measurement.source,
        "format": measurement.format,
        "digest": measurement.digest,
        "measured_duration_ps": measurement.duration,
        "tolerance": float(result.tolerance),
        "uncertainty_ps": result.uncertainty,
        "duration_ps": result.duration,
        "seed": result.seed,
        "rows": [row_json(row) for row in result.rows],
        "requirements": [limit_json(limit) for limit in result.limits],
        "distributions": [distribution_json(row) for row in result.distributions],
        "assumptions": list(result.assumptions),
        "findings": [finding_json(finding) for finding in result.findings],
        "changes": changes.content(result.differences),
        "summary": {
            "holds": result.holds,
            **{verdict.replace(" ", "_"): result.count(verdict) for verdict in Agreement},
            "missed": [limit.name for limit in result.missed],
            "text": closing_line(result),
        },
    }


def row_json(row: ComparisonRow) -> dict[str, Any]:
    """A predicted value beside a measured one."""
    low, high = row.predicted_range or (row.predicted, row.predicted)
    return {
        "object": row.object,
        "kind": row.kind,
        "trace_object": None if row.series is None else row.series.name,
        "quantity": row.quantity,
        "statistic": row.statistic,
        "predicted_ps": _whole(row.predicted),
        "predicted_low_ps": _whole(low),
        "predicted_high_ps": _whole(high),
        "measured_ps": _whole(row.measured),
        "deviation": _share(row.deviation),
        "deviation_of_prediction": _share(row.deviation_of_prediction),
        "tolerance": _share(row.tolerance),
        "bound_margin_ps": _whole(row.bound_margin),
        "verdict": row.verdict,
        "claim": row.claim,
        "method": row.method,
        "samples": row.samples,
        "reason": row.reason,
    }


def limit_json(limit: MeasuredLimit) -> dict[str, Any]:
    """A limit, judged by what was measured."""
    unit = "_ps" if limit.is_time else ""
    return {
        "name": limit.name,
        "object": limit.object,
        "quantity": limit.quantity,
        "is_upper": limit.is_upper,
        f"limit{unit}": _number(limit.limit, limit.is_time),
        f"value{unit}": _number(limit.value, limit.is_time),
        "verdict": limit.verdict,
        "samples": limit.samples,
        "reason": limit.reason,
    }


def distribution_json(row: DistributionRow) -> dict[str, Any]:
    """The distance of two distributions."""
    measured, simulated = row.distance.counts
    return {
        "object": row.object,
        "kind": row.kind,
        "quantity": row.quantity,
        "distance": float(row.distance.value),
        "critical": row.distance.critical,
        "samples": measured,
        "simulated_samples": simulated,
        "quantiles": [
            {"share": float(share), "measured_ps": of_measured, "simulated_ps": of_simulated}
            for share, (of_measured, of_simulated) in row.distance.quantiles.items()
        ],
        "is_hidden": row.is_hidden,
    }


def _whole(value: Fraction | None) -> int | None:
    return None if value is None else round(value)


def _share(value: Fraction | None) -> float | None:
    return None if value is None else float(value)


def _number(value: Fraction | None, is_time: bool) -> float | None:
    return None if value is None else round(value) if is_time else float(value)
