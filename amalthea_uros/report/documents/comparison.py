"""A comparison with a measurement as a document: predictions, bounds, distributions and limits beside what was measured."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass
from amalthea_uros.compare.results import (
    Agreement,
    Comparison,
    ComparisonRow,
    DistributionRow,
    LossRow,
    MeasuredLimit,
    Statistic,
    is_bound,
)
from amalthea_uros.measure.series import MeasuredKind
from amalthea_uros.report.basics.document import ResultDocument, Sentences, document, section, table
from amalthea_uros.report.documents.simulation import duration_text
from amalthea_uros.report.wording.cells import directed_limit, limited_text, words
from amalthea_uros.timing.basics.quantities import ChainQuantity, JobMetric
from amalthea_uros.units import Rounding, rounded_time_text, time_text

#: Quantities that are shown although they agree.
_IMPORTANT = (
    JobMetric.NET_EXECUTION_TIME,
    JobMetric.RESPONSE_TIME,
    JobMetric.START_TO_START,
    ChainQuantity.REDUCED_REACTION_TIME,
    ChainQuantity.REDUCED_DATA_AGE,
)
#: How the statistics that are shown are rounded: minimum and maximum outwards, as wherever they are shown.
_ROUNDINGS: dict[Statistic | None, Rounding] = {
    Statistic.MIN: Rounding.DOWN,
    Statistic.MEAN: Rounding.NEAREST,
    Statistic.MAX: Rounding.UP,
}


@dataclass(frozen=True, slots=True)
class BoundTest:
    """The bounds of a quantity, and the measured extreme values; None where the analysis has no bound.

    Attributes
    ----------
    verdict : the worse one of both
    """

    lower: ComparisonRow | None
    upper: ComparisonRow | None

    @property
    def rows(self) -> list[ComparisonRow]:
        """The tests, at least one."""
        return [row for row in (self.lower, self.upper) if row is not None]

    @property
    def verdict(self) -> Agreement:
        """Whether both bounds hold."""
        return Agreement.REFUTED if any(row.verdict is Agreement.REFUTED for row in self.rows) else Agreement.WITHIN

    @property
    def reason(self) -> str:
        """What is to be said about the verdict."""
        return "; ".join(filter(None, (_of_all(row) for row in self.rows)))


def _of_all(row: ComparisonRow) -> str:
    """A remark on a bound; of one that is exceeded, by how many values."""
    share = f" ({row.beyond:,} of {counted(row.samples, 'value')})" if row.reason and row.beyond is not None else ""
    return f"{row.reason}{share}"


@dataclass(frozen=True, slots=True)
class PredictionGroup:
    """The predictions of a quantity that have a tolerance.

    Attributes
    ----------
    distance : of the distributions; None if it is not known
    """

    rows: tuple[ComparisonRow, ...]
    distance: DistributionRow | None

    @property
    def verdict(self) -> Agreement:
        """The worst one."""
        return max((row.verdict for row in self.rows), key=_BADNESS.index)

    @property
    def worst(self) -> ComparisonRow:
        """The row with the largest deviation, of those that do not agree if there are any."""
        return worst_of(self.rows)

    @property
    def deviations(self) -> str:
        """Those of minimum, mean and maximum."""
        found = {row.statistic: deviation_text(row) for row in self.rows}
        texts = [found.get(statistic, "-") for statistic in _ROUNDINGS]
        return texts[0] if len(set(texts)) == 1 else " / ".join(texts)

    @property
    def remark(self) -> str:
        """What else is outside, and why the verdict is what it is."""
        others = [row for row in self.rows if row.verdict is not Agreement.WITHIN and row.statistic not in _ROUNDINGS]
        parts = [f"{row.statistic} {deviation_text(row)}" for row in others]
        if self.worst.reason or any(map(_depends_on_phase, self.rows)):
            parts.append(self.worst.reason or "nearest value of all phases")
        return ", ".join(parts)

    def times(self, is_measured: bool) -> str:
        """Minimum, mean and maximum."""
        found = {row.statistic: row.measured if is_measured else row.predicted for row in self.rows}
        return " / ".join(_time(found.get(statistic), rounding) for statistic, rounding in _ROUNDINGS.items())


def worst_of(rows: Iterable[ComparisonRow]) -> ComparisonRow:
    """The row that matters most: what is refuted, then the largest deviation of what does not agree, then of what agrees.

    Of bounds, the deviation does not matter.
    """

    def rank(row: ComparisonRow) -> tuple[int, bool, bool, Fraction]:
        is_tested = is_bound(row.claim, row.statistic)
        return _BADNESS.index(row.verdict), not is_tested, not row.reason, Fraction(0) if is_tested else _size(row)

    return max(rows, key=rank)


_BADNESS = (Agreement.WITHIN, Agreement.DIFFERS, Agreement.OUTSIDE, Agreement.REFUTED)


def prediction_groups(result: Comparison) -> list[PredictionGroup]:
    """The predictions with a tolerance that are shown."""
    groups: dict[tuple[str, MeasuredKind | None, str], list[ComparisonRow]] = {}
    for row in result.compared:
        if not is_bound(row.claim, row.statistic):
            groups.setdefault((row.object, row.kind, row.quantity), []).append(row)
    distances: dict[tuple[str, MeasuredKind | None, str], DistributionRow]
    distances = {(row.object, row.kind, row.quantity): row for row in result.distributions}
    found = [PredictionGroup(tuple(rows), distances.get(key)) for key, rows in groups.items()]
    return [group for group in found if group.verdict is Agreement.OUTSIDE or _is_shown(result, group.rows[0])]


def bound_tests(result: Comparison) -> list[BoundTest]:
    """The bounds that are shown."""
    tests: dict[tuple[str, MeasuredKind | None, str], dict[Statistic | None, ComparisonRow]] = {}
    for row in result.compared:
        if is_bound(row.claim, row.statistic):
            tests.setdefault((row.object, row.kind, row.quantity), {})[row.statistic] = row
    found = [BoundTest(rows.get(Statistic.MIN), rows.get(Statistic.MAX)) for rows in tests.values()]
    return [test for test in found if test.verdict is Agreement.REFUTED or test.reason or _is_shown(result, test.rows[0])]


def _missing_rows(result: Comparison) -> list[ComparisonRow]:
    """What is not compared and shown: of what has no prediction, the most important quantities, and times that are none of them."""
    return [
        row
        for row in result.not_compared
        if row.verdict is not Agreement.NOT_PREDICTED
        or row.quantity not in (*JobMetric, *ChainQuantity)
        or _is_shown(result, row)
    ]


def _hidden_missing(result: Comparison) -> str:
    """How many quantities without a prediction are not shown, "" if all are."""
    rest = len(result.not_compared) - len(_missing_rows(result))
    return f"{counted(rest, 'other quantity')} not predicted; --all shows them" if rest else ""


def _hidden(result: Comparison) -> str:
    """How many comparisons are not shown, "" if all are."""
    shown = [*(row for each in prediction_groups(result) for row in each.rows)]
    shown += [row for each in bound_tests(result) for row in each.rows]
    rest = len(result.compared) - len(shown)
    differing = result.count(Agreement.DIFFERS) - sum(row.verdict is Agreement.DIFFERS for row in shown)
    some = f", or {_EXCUSED} ({differing})" if differing else ""
    return f"{counted(rest, 'other comparison')} within{some}; --all shows them" if rest else ""


def _is_shown(result: Comparison, row: ComparisonRow) -> bool:
    """Whether a quantity is shown although it agrees: the most important ones of processes and chains, or of what else there is."""
    if result.with_all:
        return True
    has_others = any(each.kind is not MeasuredKind.RUNNABLE for each in result.compared)
    return row.quantity in _IMPORTANT and not (has_others and row.kind is MeasuredKind.RUNNABLE)


def _subject_line(result: Comparison) -> str:
    """What is compared with what, and how."""
    measurement = result.measurement
    of_model = f" of {result.model}" if result.model else ""
    run = "" if result.duration is None else f", simulation of {duration_text(result.duration)} with seed {result.seed}"
    duration = duration_text(measurement.duration) if measurement.duration else ""
    source = f"{measurement.source} ({', '.join(filter(None, (measurement.format, duration)))})"
    return f"Comparison{of_model} with {source}: tolerance {_percent(result.tolerance)} of the measurement{run}"


def closing_line(result: Comparison) -> str:
    """Whether the model holds, and which limits were measured as missed."""
    return "; ".join(filter(None, (_outcome(result), _missed(result.missed))))


def _outcome(result: Comparison) -> str:
    refuted = [row for row in result.rows if row.verdict is Agreement.REFUTED]
    outside = [row for row in result.rows if row.verdict is Agreement.OUTSIDE]
    if refuted:
        others = f"; {counted(len(refuted) - 1, 'other bound')} exceeded" if refuted[1:] else ""
        return f"Model refuted: {_what(refuted[0])} is {_extreme(refuted[0])}, {refuted[0].reason}{others}"
    if not result.compared:
        return "Nothing compared: no measured quantity is predicted"
    tolerance = f"{_percent(result.tolerance)} of the measurement"
    number, within = len(result.compared), [row for row in result.compared if row.verdict is Agreement.WITHIN]
    if outside:
        return f"Model does not hold: {len(outside)} of {counted(number, 'comparison')} outside {tolerance}{_largest(outside)}"
    if not within:
        return f"Nothing agrees: {counted(number, 'comparison')} outside {tolerance}, {_EXCUSED}"
    differing = f"; {number - len(within)} outside, {_EXCUSED}" if number > len(within) else ""
    near = [row for row in within if _size(row) <= result.tolerance]
    missing = {row.object for row in result.not_compared} - {row.object for row in result.compared}
    rest = f"; not compared: {counted(len(missing), 'object')}" if missing else ""
    found = f"{counted(len(within), 'comparison')} within {tolerance}{_largest(near)}"
    return f"Model holds: {found}{differing}{rest}{_scarce(result)}{_lost(result)}{_damaged(result)}"


#: What is to be said of deviations that contradict nothing.
_EXCUSED = "without contradicting what the model states"


#: Of so many quantities, all distributions are shown.
_FEW_QUANTITIES = 3
#: The extremes of fewer values say little.
_FEW = 5


def _scarce(result: Comparison) -> str:
    """Of what the fewest values were measured, if these are few."""
    fewest = min(result.compared, key=lambda row: row.samples)
    if fewest.samples >= _FEW:
        return ""
    return f"; only {counted(fewest.samples, 'value')} of the {words(fewest.quantity)} of {fewest.object}"


def _lost(result: Comparison) -> str:
    """Of what the greatest share of values was lost, of which nothing is known."""
    worst = max(result.losses, key=lambda row: row.share, default=None)
    return "" if worst is None else f"; {_percent(worst.share)} of the values of {worst.object} lost"


def _damaged(result: Comparison) -> str:
    return "; but a part of the measurement could not be used, see the errors" if result.is_damaged else ""


#: Smaller deviations are shown as none.
_SMALLEST = Fraction(5, 10_000)


def _largest(rows: Sequence[ComparisonRow]) -> str:
    """The largest deviation of a prediction that is no bound."""
    tolerated = (row for row in rows if not is_bound(row.claim, row.statistic))
    deviations = [row for row in tolerated if _size(row) >= _SMALLEST]
    worst = max(deviations, key=_size, default=None)
    return "" if worst is None else f"; largest deviation {deviation_text(worst)} ({_what(worst)})"


def _missed(limits: Sequence[MeasuredLimit]) -> str:
    if not limits:
        return ""
    first = limits[0]
    others = f", and {counted(len(limits) - 1, 'other limit')}" if limits[1:] else ""
    if first.value is None and first.reason:
        return f"limit missed: {first.object}: {first.reason}{others}"
    value = f" is {_value_text(first)}," if first.value is not None and first.is_time else ""
    return f"limit missed: {first.quantity} of {first.object}{value} {_limit_text(first)}{others}"


def _what(row: ComparisonRow) -> str:
    """What a row compares: "mean response time of Control_Function"."""
    return f"{row.statistic} {words(row.quantity)} of {row.object}"


def _percent(share: Fraction) -> str:
    """A share in percent, with three digits."""
    return f"{float(share * 100):.3g} %"


def deviation_text(row: ComparisonRow) -> str:
    """The deviation in percent of the measurement, with its sign: positive if more was measured than predicted."""
    if row.deviation is None:
        return "-"
    return f"{float(row.deviation * 100):+.1f} %" if _size(row) >= _SMALLEST else "0 %"


def _size(row: ComparisonRow) -> Fraction:
    return abs(row.deviation or Fraction(0))


def _limit_text(limit: MeasuredLimit) -> str:
    """The limit, such as "at most 1 ms"."""
    if limit.limit is None:
        return "-"
    value = time_text(limit.limit) if limit.is_time else f"{float(limit.limit):g}"
    return directed_limit(value, is_upper=limit.is_upper)


def _value_text(limit: MeasuredLimit) -> str:
    """The measured value of the limited quantity, on its side of the limit."""
    return _time(limit.value if limit.is_time else None, Rounding.UP if limit.is_upper else Rounding.DOWN, limit.limit)


def _distribution_rows(result: Comparison) -> Iterator[tuple[str, ...]]:
    """The cells of the distributions that are shown: the distance, and both medians and 99 % quantiles."""
    for row in result.distributions:
        if not (result.with_all or row.is_hidden or len(result.distributions) <= _FEW_QUANTITIES):
            continue
        between = row.distance
        median, high = (between.quantiles[share] for share in (Fraction(50, 100), Fraction(99, 100)))
        yield (
            row.object,
            words(row.quantity),
            f"{float(between.value):.3f}",
            f"{between.critical:.3f}",
            *(_time(Fraction(value)) for value in (*median, *high)),
            "equal means, other distribution" if row.is_hidden else "",
        )


def _loss_cells(row: LossRow) -> tuple[str, ...]:
    """The cells of what was lost."""
    simulated = "-" if row.simulated is None else _percent(row.simulated)
    return row.object, words(row.quantity), f"{row.values:,}", f"{row.lost:,}", _percent(row.share), simulated


def _time(value: Fraction | None, rounding: Rounding = Rounding.NEAREST, limit: Fraction | None = None) -> str:
    return "-" if value is None else rounded_time_text(value, rounding, limit)


def _prediction_cells(group: PredictionGroup) -> tuple[str, ...]:
    """The cells of the predictions of a quantity."""
    first, distance = group.rows[0], group.distance
    return (
        first.object,
        words(first.quantity),
        f"{first.samples:,}",
        group.times(is_measured=True),
        group.times(is_measured=False),
        str(first.claim),
        group.deviations,
        "-" if distance is None else f"{float(distance.distance.value):.3f}",
        str(group.verdict),
        group.remark,
    )


def _depends_on_phase(row: ComparisonRow) -> bool:
    low, high = row.predicted_range or (Fraction(0), Fraction(0))
    return high - low > _SMALLEST * abs(high)


def _bound_cells(test: BoundTest) -> tuple[str, ...]:
    """The cells of a test of bounds: minimum, maximum, and by how much they are on the safe side."""
    lower, upper = test.lower, test.upper
    return (
        test.rows[0].object,
        words(test.rows[0].quantity),
        "-" if lower is None else _time(lower.predicted, Rounding.DOWN),
        "-" if lower is None else _extreme(lower),
        "-" if upper is None else _extreme(upper),
        "-" if upper is None else _time(upper.predicted, Rounding.UP),
        "-" if upper is None else _time(upper.bound_margin, Rounding.DOWN),
        str(test.rows[0].claim),
        str(test.verdict),
        test.reason,
    )


def _extreme(row: ComparisonRow) -> str:
    """A measured extreme value, on its side of the bound."""
    return _time(row.measured, _ROUNDINGS.get(row.statistic, Rounding.NEAREST), row.predicted)


def _limit_cells(limit: MeasuredLimit) -> tuple[str, ...]:
    """The cells of a limit."""
    return (
        limit.name,
        limited_text(limit.quantity, limit.object),
        _limit_text(limit),
        _value_text(limit),
        f"{limit.samples:,}",
        words(limit.verdict),
        limit.reason,
    )


#: What the times of a row are.
_SERIES = ("object", "quantity")


def comparison_document(result: Comparison) -> ResultDocument:
    """Tables of predictions, bounds, distributions and limits, what was not compared, and whether the model holds."""
    predictions = "Predictions (min / mean / max; deviation: of the measurement, positive if more was measured than predicted)"
    predicted = (*_SERIES, "~~>values", ">measured", ">predicted", "~claim", ">deviation", "~~~>distance", "verdict", "")
    bounds = "Bounds of the analysis (nothing may be measured beyond them, without tolerance)"
    bounded = (*_SERIES, "~~>lower bound", "~~~>min", ">max", ">upper bound", "~>margin", "~~~~claim", "verdict", "")
    distance = "Distributions (Kolmogorov-Smirnov distance from the simulated values, and its critical value at 5 %)"
    distributed = (*_SERIES, ">distance", "~>critical", "~~~>p50", "~~>simulated p50", ">p99", ">simulated p99", "")
    lost = (*_SERIES, ">values", ">lost", ">share", ">simulated")
    limited = ("requirement", "what", "limit", ">measured", ">values", "verdict", "")
    missing = [(row.object, words(row.quantity), str(row.verdict), row.reason) for row in _missing_rows(result)]
    not_shown, not_predicted = (Sentences([text] if text else []) for text in (_hidden(result), _hidden_missing(result)))
    sections = (
        section(predictions, table("", predicted, map(_prediction_cells, prediction_groups(result)))),
        section(bounds, table("", bounded, map(_bound_cells, bound_tests(result))), not_shown),
        section(distance, table("", distributed, _distribution_rows(result))),
        section(
            "Lost values (share; stimuli without a response in the simulation)",
            table("", lost, map(_loss_cells, result.losses)),
        ),
        section("Limits, as measured", table("", limited, map(_limit_cells, result.limits))),
        section("Not compared", table("", (*_SERIES, "", "reason"), missing), not_predicted),
        section("Assumptions", Sentences(result.assumptions)),
    )
    return document(sections, closing_line(result), "Comparison with a measurement", _subject_line(result))
