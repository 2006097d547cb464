"""Pictures of measurements, comparisons and sweeps as SVG."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from amalthea_uros.compare.results import Agreement, Comparison, ComparisonRow, PredictionClaim, Statistic, is_bound
from amalthea_uros.design.campaign.sweeps import SCHEDULABLE, SweepResult
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.judge.summary import Schedulable
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.measure.series import MeasuredKind, Measurement, Series
from amalthea_uros.names import listed, require
from amalthea_uros.report.documents import measurement as measured
from amalthea_uros.report.documents.comparison import (
    bound_tests,
    closing_line,
    deviation_text,
    prediction_groups,
    worst_of,
)
from amalthea_uros.report.pictures.compared_times import ComparedQuantity, DrawnInterval, compared_times
from amalthea_uros.report.pictures.histogram import HistogramPicture, Mark, MarkKind, histogram
from amalthea_uros.report.pictures.swept import SweptPicture, draw_swept
from amalthea_uros.report.wording.cells import words
from amalthea_uros.units import Time, time_text


def histogram_picture(measurement: Measurement, name: str) -> str:
    """The values of a series.

    Parameters
    ----------
    name : of an object, for its first series, or with a quantity such as "Task.start_to_start"

    Raises
    ------
    InvalidArgumentError : there is no such series, or its single values are not known.
    """
    series = _named_series(measurement, name)
    found = measured.histogram_of(series, measurement.resolution)
    if found is None or series.statistics is None:
        raise InvalidArgumentError(f"the single values of {name!r} are not known, so there is no histogram")
    words = series.quantity.replace("_", " ")
    statistics = series.statistics
    marks = [Mark("min", statistics.min), Mark("mean", statistics.mean), Mark("max", statistics.max)]
    if measured.P99 in statistics.percentiles:
        marks.append(Mark("p99", statistics.percentiles[measured.P99]))
    if series.period is not None:
        marks.append(Mark("period", series.period, MarkKind.LIMIT))
    edges = tuple(map(int, found.edges))
    things = "jobs" if series.kind is MeasuredKind.PROCESS else "values"
    title = f"{measurement.source}: {words} of {series.name}"
    return histogram(HistogramPicture(title, edges, "measured", found.counts, tuple(marks), words, things))


def _named_series(measurement: Measurement, name: str) -> Series:
    first = next((series for series in measurement.series if series.name == name), None)
    if first is not None:
        return first
    of, _, quantity = name.rpartition(".")
    require("measured object", [of or name], dict.fromkeys(series.name for series in measurement.series))
    found = measurement.find(of, quantity)
    if found is None:
        known = listed([series.quantity for series in measurement.series if series.name == of])
        raise InvalidArgumentError(f"{quantity!r} of {of!r} was not measured; known: {known}")
    return found


#: More quantities are not drawn.
_MOST_COMPARED = 24


def comparison_picture(result: Comparison) -> str:
    """Predicted intervals beside measured distributions, of the quantities that a text shows."""
    groups: dict[tuple[str, MeasuredKind | None, str], None] = {}
    firsts = (*(each.rows[0] for each in prediction_groups(result)), *(each.rows[0] for each in bound_tests(result)))
    for first in firsts:
        groups.setdefault((first.object, first.kind, first.quantity))
    drawn = [_quantity([row for row in result.compared if _key(row) == key]) for key in list(groups)[:_MOST_COMPARED]]
    title = f"{result.model or 'model'} compared with {result.measurement.source}"
    return compared_times(title, closing_line(result), drawn, len(groups) - len(drawn))


def _key(row: ComparisonRow) -> tuple[str, MeasuredKind | None, str]:
    return row.object, row.kind, row.quantity


def _quantity(rows: Sequence[ComparisonRow]) -> ComparedQuantity:
    measured = {row.statistic: row.measured for row in rows}
    bounds = {row.statistic: row.predicted for row in rows if is_bound(row.claim, row.statistic)}
    simulated = [row for row in rows if row.claim is PredictionClaim.SIMULATED]
    worst = worst_of(rows)
    return ComparedQuantity(
        name=rows[0].object,
        quantity=words(rows[0].quantity),
        measured=DrawnInterval(measured.get(Statistic.MIN), measured.get(Statistic.MAX), measured.get(Statistic.MEAN)),
        values=_measured_values(rows[0]),
        simulated=_simulated(simulated) if simulated else None,
        bounds=DrawnInterval(bounds.get(Statistic.MIN), bounds.get(Statistic.MAX)) if bounds else None,
        verdict=str(worst.verdict),
        remark=_remark(worst),
        agrees=worst.verdict in (Agreement.WITHIN, Agreement.DIFFERS),
    )


def _measured_values(row: ComparisonRow) -> tuple[tuple[Time, int], ...]:
    """How often which time was measured."""
    if row.series is None or row.series.values is None:
        return ()
    values, counts = np.unique(row.series.values, return_counts=True)
    return tuple(zip(values.tolist(), counts.tolist(), strict=True))


def _simulated(rows: Sequence[ComparisonRow]) -> DrawnInterval:
    predicted = {row.statistic: row.predicted for row in rows}
    return DrawnInterval(predicted.get(Statistic.MIN), predicted.get(Statistic.MAX), predicted.get(Statistic.MEAN))


def _remark(row: ComparisonRow) -> str:
    """The deviation, or by how much a bound is exceeded."""
    if row.bound_margin is not None:
        return f"{time_text(abs(row.bound_margin))} beyond bound" if row.bound_margin < 0 else ""
    return f"{deviation_text(row)} ({row.statistic})" if row.deviation else "0 %"


_VERDICTS = {Schedulable.YES: Verdict.MET, Schedulable.NO: Verdict.MISSED, Schedulable.UNKNOWN: Verdict.UNKNOWN}


def sweep_picture(result: SweepResult, quantity: str) -> str:
    """A quantity over the one or two swept values, as SVG.

    Raises
    ------
    InvalidArgumentError : there is no such quantity, it is no number, or there are too many values for a picture.
    """
    column = result.column(quantity)
    keys = {tuple(change.value for change in outcome.run.changes): outcome for outcome in result.outcomes}
    values: dict[tuple[str, ...], Fraction | None] = {}
    for key, outcome in keys.items():
        value = outcome.record.get(column)
        if isinstance(value, str):
            raise InvalidArgumentError(f"{quantity!r} is no number, so it cannot be drawn")
        values[key] = None if value is None else Fraction(value)
    sweeps = result.plan.sweeps
    return draw_swept(
        SweptPicture(
            quantity=column.removesuffix("_ps"),
            is_time=column.endswith("_ps"),
            targets=tuple(f"{sweep.object}.{sweep.key}" for sweep in sweeps),
            axes=tuple(tuple(sweep.values) for sweep in sweeps),
            values=values,
            verdicts={
                key: _VERDICTS[Schedulable(str(found))] for key, each in keys.items() if (found := each.record.get(SCHEDULABLE))
            },
        )
    )
