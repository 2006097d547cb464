"""A measurement for programs; times are whole picoseconds."""

from __future__ import annotations

from typing import Any

from amalthea_uros.measure.series import Counts, Measurement, Series, TimeStatistics
from amalthea_uros.report.findings import finding_json
from amalthea_uros.report.json.simulation_result import histogram_json
from amalthea_uros.report.measured import closing_line, exceedance, histogram_of
from amalthea_uros.units import Time


def content(measurement: Measurement) -> dict[str, Any]:
    """Everything that was measured; the figures of a single object are at the top as well."""
    measured = [series for series in measurement.series if series.statistics is not None]
    only = measured[0] if len({series.name for series in measured}) == 1 else None
    found = series_json(only, measurement.resolution) if only is not None else {}
    return {
        "trace": measurement.source,
        "format": measurement.format,
        "digest": measurement.digest,
        "duration_ps": measurement.duration,
        "resolution_ps": measurement.resolution,
        "findings": [finding_json(finding) for finding in measurement.findings],
        **{key: found.get(key) for key in ("samples", "latency", "histogram")},
        "series": [series_json(series, measurement.resolution) for series in measurement.series],
        "summary": {"text": closing_line(measurement)},
    }


def series_json(series: Series, resolution: Time | None = None) -> dict[str, Any]:
    """A series, without its single values."""
    found, histogram = series.statistics, histogram_of(series, resolution)
    limit = None if found is None else exceedance(found.count)
    return {
        "object": series.name,
        "kind": series.kind,
        "quantity": series.quantity,
        "samples": 0 if found is None else found.count,
        "latency": None if found is None else statistics_json(found),
        "jitter": None if found is None else _jitter(series, found),
        "exceedance": None if limit is None else float(limit),
        "histogram": None if histogram is None else histogram_json(histogram),
        "counts": _counts(series.counts),
        "baseline": None if series.baseline is None else statistics_json(series.baseline),
        "net_range": None if series.net_range is None else dict(zip(("min_ps", "max_ps"), series.net_range, strict=True)),
        "method": series.method,
    }


def _jitter(series: Series, found: TimeStatistics) -> dict[str, Any]:
    return {
        "peak_to_peak_ps": found.peak_to_peak,
        "std_ps": None if found.std is None else round(found.std),
        "mean_squared_deviation_us2": None if found.variance is None else float(found.variance) / 1e12,
        "period_ps": series.period,
        "period_deviation_ps": series.period_deviation,
    }


def statistics_json(found: TimeStatistics) -> dict[str, Any]:
    """Statistics; percentiles of too few values are null."""
    percentiles = dict.fromkeys(("p50", "p90", "p95", "p99", "p99_9"))
    percentiles |= {f"p{float(100 * share):g}".replace(".", "_"): value for share, value in found.percentiles.items()}
    return {
        "min_ps": found.min,
        "avg_ps": round(found.mean),
        "max_ps": found.max,
        "std_ps": None if found.std is None else round(found.std),
        **{f"{name}_ps": value for name, value in percentiles.items()},
    }


def _counts(counts: Counts) -> dict[str, int]:
    return {
        "incomplete": counts.incomplete,
        "lost": counts.lost,
        "duplicated": counts.duplicated,
        "reordered": counts.reordered,
    }
