"""The fields of measurements, of comparisons with them, and of calibrations by them; times are whole picoseconds."""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from typing import Any

from amalthea_uros.compare.calibration.calibration import Calibration
from amalthea_uros.compare.calibration.values import CalibratedValue
from amalthea_uros.compare.results import (
    Agreement,
    Comparison,
    ComparisonRow,
    DistributionRow,
    LossRow,
    MeasuredLimit,
)
from amalthea_uros.measure.series import Counts, Measurement, Series, TimeStatistics
from amalthea_uros.report.documents import comparison as compared
from amalthea_uros.report.documents import measurement as measured
from amalthea_uros.report.fields import changes, simulation
from amalthea_uros.report.fields.declaration import ALSO, declare, fields_of, json_of
from amalthea_uros.units import Time

#: Declare differences and histograms.
_USED = (changes, simulation)
_PERCENTILES = ("p50_ps", "p90_ps", "p95_ps", "p99_ps", "p99_9_ps")


def _series(measurement: Measurement) -> list[dict[str, Any]]:
    return [_with_histogram(series, measurement.resolution) for series in measurement.series]


def _with_histogram(series: Series, resolution: Time | None) -> dict[str, Any]:
    """The fields of a series; no bin of its histogram is narrower than the step of the clock."""
    found: dict[str, Any] = json_of(series)
    found["histogram"] = json_of(measured.histogram_of(series, resolution))
    return found


def _only(measurement: Measurement) -> dict[str, Any]:
    """The figures of a single object, which are at the top as well."""
    series = [each for each in measurement.series if each.statistics is not None]
    only = _with_histogram(series[0], measurement.resolution) if len({each.name for each in series}) == 1 else {}
    return {name: only.get(name) for name in ("samples", "latency", "histogram")}


def _jitter(series: Series) -> dict[str, Any] | None:
    found = series.statistics
    if found is None:
        return None
    return fields_of(
        {
            "peak_to_peak_ps": found.peak_to_peak,
            "std_ps": found.std,
            "mean_squared_deviation_us2": None if found.variance is None else float(found.variance) / 1e12,
            "period_ps": series.period,
            "period_deviation_ps": series.period_deviation,
        }
    )


def _percentiles(found: TimeStatistics) -> dict[str, Any]:
    """The percentiles by their names; those of too few values are null."""
    return dict.fromkeys(_PERCENTILES) | {_name(share): value for share, value in found.percentiles.items()}


@cache
def _name(share: Fraction) -> str:
    """The name of a percentile."""
    return f"p{float(100 * share):g}_ps".replace(".", "_")


declare(
    Measurement,
    ("trace", "source"),
    *("format", "digest", "duration_ps", "resolution_ps", "findings"),
    (ALSO, _only),
    ("series", _series),
    ("summary", lambda measurement: {"text": measured.closing_line(measurement)}),
)
declare(
    Series,
    ("object", "name"),
    *("kind", "quantity"),
    ("samples", lambda series: 0 if series.statistics is None else series.statistics.count),
    ("latency", "statistics"),
    ("jitter", _jitter),
    ("exceedance", lambda series: series.statistics and measured.exceedance(series.statistics.count)),
    ("histogram", lambda _series: None),
    *("counts", "baseline"),
    ("net_range", lambda series: series.net_range and dict(zip(("min_ps", "max_ps"), series.net_range, strict=True))),
    "method",
)
declare(TimeStatistics, "min_ps", ("avg_ps", "mean"), "max_ps", "std_ps", (ALSO, _percentiles))
declare(Counts, *("incomplete", "lost", "duplicated", "reordered", "lost_activations"))


def _range(row: ComparisonRow) -> dict[str, Any]:
    """Between which values a prediction is."""
    lower, upper = row.predicted_range or (row.predicted, row.predicted)
    return {"predicted_low_ps": lower, "predicted_high_ps": upper}


def _limited(limit: MeasuredLimit) -> dict[str, Any]:
    unit = "_ps" if limit.is_time else ""
    return {f"limit{unit}": limit.limit, f"value{unit}": limit.value}


def _quantiles(row: DistributionRow) -> list[dict[str, Any]]:
    return [
        {"share": share, "measured_ps": of_measured, "simulated_ps": of_simulated}
        for share, (of_measured, of_simulated) in row.distance.quantiles.items()
    ]


declare(
    Comparison,
    "model",
    ("trace", "measurement.source"),
    ("format", "measurement.format"),
    ("digest", "measurement.digest"),
    ("measured_duration_ps", "measurement.duration"),
    *("tolerance", "uncertainty_ps", "duration_ps", "seed", "rows"),
    ("requirements", "limits"),
    *("distributions", "losses", "assumptions", "findings"),
    ("changes", "differences"),
    (
        "summary",
        lambda result: {
            "holds": result.holds,
            **{verdict.replace(" ", "_"): result.count(verdict) for verdict in Agreement},
            "missed": [limit.name for limit in result.missed],
            "text": compared.closing_line(result),
        },
    ),
)
declare(
    ComparisonRow,
    *("object", "kind"),
    ("trace_object", "series.name"),
    *("quantity", "statistic", "predicted_ps"),
    (ALSO, _range),
    *("measured_ps", "deviation", "deviation_of_prediction", "tolerance", "bound_margin_ps"),
    *("verdict", "claim", "method", "samples", "beyond", "reason"),
)
declare(LossRow, *("object", "kind", "quantity", "values", "lost", "share", ("simulated_share", "simulated")))
declare(MeasuredLimit, *("name", "object", "quantity", "is_upper"), (ALSO, _limited), *("verdict", "samples", "reason"))
declare(
    DistributionRow,
    *("object", "kind", "quantity"),
    ("distance", "distance.value"),
    ("critical", "distance.critical"),
    ("samples", lambda row: row.distance.counts[0]),
    ("simulated_samples", lambda row: row.distance.counts[1]),
    ("quantiles", _quantiles),
    "is_hidden",
)
declare(
    Calibration,
    ("description", "path"),
    ("traces", "sources"),
    ("form", "options.form"),
    ("margin", "options.margin"),
    ("tighten", "options.tighten"),
    ("judge_on", "options.judge_on"),
    "values",
    ("refuted", lambda found: sum(bool(value.refuted) for value in found.values)),
    ("changed", lambda found: found.text != found.before),
    "findings",
)
declare(
    CalibratedValue,
    "target",
    ("measured", lambda value: ", ".join(value.measured)),
    "quantity",
    ("traces", lambda value: ", ".join(value.sources)),
    ("samples", "statistics.count"),
    ("min_ps", "statistics.min"),
    ("avg_ps", "statistics.mean"),
    ("max_ps", "statistics.max"),
    "line",
    ("from", "before"),
    ("to", "after"),
    "outcome",
    ("refuted", lambda value: ", ".join(value.refuted)),
    ("judged", "held_out"),
    *("outside", "reason"),
)
