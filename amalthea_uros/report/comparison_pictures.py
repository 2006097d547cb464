"""Pictures of comparisons as SVG."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from amalthea_uros.compare.results import Agreement, Comparison, ComparisonRow, PredictionClaim, Statistic, is_bound
from amalthea_uros.measure.series import MeasuredKind
from amalthea_uros.report.documents.comparison import (
    bound_tests,
    closing_line,
    deviation_text,
    prediction_groups,
    quantity_text,
    worst_of,
)
from amalthea_uros.report.pictures.compared_times import ComparedQuantity, DrawnInterval, compared_times
from amalthea_uros.units import Time, time_text

#: More quantities are not drawn.
_MOST = 24


def comparison_picture(result: Comparison) -> str:
    """Predicted intervals beside measured distributions, of the quantities that a text shows."""
    groups: dict[tuple[str, MeasuredKind | None, str], None] = {}
    firsts = (*(each.rows[0] for each in prediction_groups(result)), *(each.rows[0] for each in bound_tests(result)))
    for first in firsts:
        groups.setdefault((first.object, first.kind, first.quantity))
    drawn = [_quantity([row for row in result.compared if _key(row) == key]) for key in list(groups)[:_MOST]]
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
        quantity=quantity_text(rows[0].quantity),
        measured=DrawnInterval(measured.get(Statistic.MIN), measured.get(Statistic.MAX), measured.get(Statistic.MEAN)),
        values=_values(rows[0]),
        simulated=_simulated(simulated) if simulated else None,
        bounds=DrawnInterval(bounds.get(Statistic.MIN), bounds.get(Statistic.MAX)) if bounds else None,
        verdict=str(worst.verdict),
        remark=_remark(worst),
        agrees=worst.verdict in (Agreement.WITHIN, Agreement.DIFFERS),
    )


def _values(row: ComparisonRow) -> tuple[tuple[Time, int], ...]:
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
