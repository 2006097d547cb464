"""Whether a prediction agrees with a measured value.

Like is compared with like. What an analysis says of a minimum or a maximum is a bound, also where it is exact: a finite measurement
need not contain the extreme case, but must not exceed it. There is no tolerance for that, only for what is known of the measurement
itself. Means, and what a simulation of like length has, agree within the tolerance.

Only what is stated can be contradicted. Extreme values that are less extreme than the predicted ones contradict nothing. Where the
distribution of times is not stated, neither do means and percentiles that depend on it; where it is, they differ by chance.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from math import ceil, floor, sqrt
from typing import NamedTuple

from amalthea_uros._internal.records import dataclass
from amalthea_uros.compare.results import Agreement, ComparisonRow, PredictionClaim, Statistic, is_bound
from amalthea_uros.measure.series import Series, TimeStatistics
from amalthea_uros.timing.stated_distributions import Basis
from amalthea_uros.units import Time, time_text


@dataclass(frozen=True, slots=True, kw_only=True)
class Prediction:
    """A predicted value in picoseconds.

    Attributes
    ----------
    high : the other end of a range of values that are possible, each in another phase; None if it is one value
    count : number of simulated values; None if it does not come from a simulation
    """

    value: Fraction
    claim: PredictionClaim
    method: str
    high: Fraction | None = None
    count: int | None = None

    def nearest(self, measured: Fraction) -> Fraction:
        """The possible value that is nearest to a measured one."""
        return self.value if self.high is None else min(max(measured, self.value), self.high)


class MeasuredEnds(NamedTuple):
    """Between which ends a measured value really is."""

    lower: Fraction
    upper: Fraction


@dataclass(frozen=True, slots=True, kw_only=True)
class Rule:
    """How values are compared.

    Attributes
    ----------
    tolerance : of the deviation, relative to the measurement
    uncertainty : by how much a measured time may be wrong, in picoseconds
    is_reached : whether it may be wrong by all of that; the difference of two time stamps is wrong by less than their step
    """

    tolerance: Fraction
    uncertainty: Time
    is_reached: bool = False

    def is_possible(self, predicted: Fraction, ends: MeasuredEnds) -> bool:
        """Whether a measured value may really be a predicted one."""
        if self.is_reached:
            return ends.lower <= predicted <= ends.upper
        return ends.lower < predicted < ends.upper


def measured_values(statistics: TimeStatistics) -> Mapping[Statistic, Fraction]:
    """The statistics that are compared."""
    found = {
        Statistic.MIN: Fraction(statistics.min),
        Statistic.MEAN: statistics.mean,
        Statistic.MAX: Fraction(statistics.max),
        Statistic.JITTER: Fraction(statistics.peak_to_peak),
    }
    percentile = statistics.percentiles.get(Fraction(99, 100))
    return found if percentile is None else {**found, Statistic.P99: Fraction(percentile)}


def compared(
    series: Series, name: str, quantity: str, predictions: Mapping[Statistic, tuple[Prediction, ...]], rule: Rule, basis: Basis
) -> Iterator[ComparisonRow]:
    """The rows of a series: each statistic of which there is a prediction.

    Parameters
    ----------
    name, quantity : what is predicted
    basis : what the distribution of the quantity follows from
    """
    assert series.statistics is not None
    values = measured_values(series.statistics)
    for statistic in Statistic:
        for prediction in predictions.get(statistic, ()) if statistic in values else ():
            if not _is_comparable(series, statistic, prediction):
                continue
            measured = values[statistic]
            agreement, reason = _judged(statistic, measured, _certain(series, statistic, measured, rule), prediction, rule)
            if agreement is Agreement.OUTSIDE:
                reason = _excuse(series, statistic, prediction, predictions, basis)
                agreement = Agreement.DIFFERS if reason else agreement
            yield ComparisonRow(
                object=name,
                kind=series.kind,
                quantity=quantity,
                statistic=statistic,
                verdict=agreement,
                measured=measured,
                predicted=prediction.nearest(measured),
                predicted_range=None if prediction.high in (None, prediction.value) else (prediction.value, prediction.high),
                claim=prediction.claim,
                method=prediction.method,
                tolerance=None if is_bound(prediction.claim, statistic) else rule.tolerance,
                samples=series.statistics.count,
                beyond=_number_beyond(series, statistic, prediction),
                reason=reason or (LEAST if series.is_least else ""),
                series=series,
            )


def _number_beyond(series: Series, statistic: Statistic, prediction: Prediction) -> int | None:
    """How many values are beyond a bound."""
    if series.values is None or not is_bound(prediction.claim, statistic):
        return None
    is_upper = statistic is Statistic.MAX
    bound = floor(prediction.high or prediction.value) if is_upper else ceil(prediction.value)
    return int(((series.values > bound) if is_upper else (series.values < bound)).sum())


#: What is to be said of latencies that are measured without knowing what a response belongs to.
LEAST = "without the number of the stimulus, only the least possible latencies are measured"


def _certain(series: Series, statistic: Statistic, value: Fraction, rule: Rule) -> MeasuredEnds:
    """What is certain of a measured value; of a jitter, both of its ends can be wrong.

    With a baseline, its mean was subtracted; the share of a single value is anything within the baseline's values.
    """
    wrong = Fraction(rule.uncertainty) * (2 if statistic is Statistic.JITTER else 1)
    baseline = series.baseline
    if baseline is None or statistic is Statistic.MEAN:
        return MeasuredEnds(value - wrong, value + wrong)
    below, above = baseline.max - baseline.mean, baseline.mean - baseline.min
    if statistic is Statistic.JITTER:
        below = above = below + above
    return MeasuredEnds(value - wrong - below, value + wrong + above)


def _is_comparable(series: Series, statistic: Statistic, prediction: Prediction) -> bool:
    """Whether a prediction says something about a measured value: of the least possible latencies, only the maximum can be too long."""
    return not series.is_least or (statistic is Statistic.MAX and is_bound(prediction.claim, statistic))


def _judged(
    statistic: Statistic, measured: Fraction, ends: MeasuredEnds, prediction: Prediction, rule: Rule
) -> tuple[Agreement, str]:
    """The verdict, with its reason."""
    predicted = prediction.nearest(measured)
    is_uncertain = rule.is_possible(predicted, ends)
    if is_bound(prediction.claim, statistic):
        is_upper = statistic is Statistic.MAX
        beyond = measured - predicted if is_upper else predicted - measured
        if beyond <= 0:
            return Agreement.WITHIN, ""
        side = f"{time_text(beyond)} {'above the upper' if is_upper else 'below the lower'} bound"
        return (Agreement.WITHIN, f"{side}, {_UNCERTAIN}") if is_uncertain else (Agreement.REFUTED, side)
    if abs(measured - predicted) <= rule.tolerance * abs(measured) or _is_inside(statistic, measured, predicted):
        return Agreement.WITHIN, ""
    return (Agreement.WITHIN, f"the difference is {_UNCERTAIN}") if is_uncertain else (Agreement.OUTSIDE, "")


def _is_inside(statistic: Statistic, measured: Fraction, predicted: Fraction) -> bool:
    """Whether measured extreme values are less extreme than predicted ones, which a finite measurement need not contain."""
    return measured > predicted if statistic is Statistic.MIN else statistic in _UPPER_ENDS and measured < predicted


_UPPER_ENDS = (Statistic.MAX, Statistic.JITTER)


def _excuse(
    series: Series,
    statistic: Statistic,
    prediction: Prediction,
    predictions: Mapping[Statistic, tuple[Prediction, ...]],
    basis: Basis,
) -> str:
    """Why a deviation does not contradict what the model states, "" if it does."""
    if basis.open and not (statistic is Statistic.MEAN and basis.has_mean):
        return basis.reason
    if not basis.is_random:
        return ""
    assert series.statistics is not None
    measured, counts = series.statistics, (series.statistics.count, prediction.count)
    match statistic:
        case Statistic.MEAN:
            predicted = prediction.nearest(measured.mean)
            ends = [each for found in (Statistic.MIN, Statistic.MAX) for each in predictions.get(found, ())]
            low = min([Fraction(measured.min), predicted, *(each.value for each in ends)])
            high = max([Fraction(measured.max), predicted, *(each.high or each.value for each in ends)])
            is_chance = abs(measured.mean - predicted) <= _by_chance(
                low, _pooled(measured.mean, predicted, *counts), high, *counts
            )
        case Statistic.P99 if series.values is not None:
            above = Fraction(int((series.values > int(prediction.high or prediction.value)).sum()), measured.count)
            is_chance = above - _ABOVE <= _by_chance(0, _ABOVE, 1, *counts)
        case _:
            is_chance = True
    return _CHANCE if is_chance else ""


#: The share of values above a percentile of 99 %.
_ABOVE = Fraction(1, 100)
_CHANCE = "values with a stated distribution differ so much by chance"
#: Chance exceeds the bound on a deviation with a probability of at most 2 exp(-8), which is less than 0.1 %.
_EXPONENT = 8


def _pooled(measured: Fraction, predicted: Fraction, count: int, simulated: int | None) -> Fraction:
    """The mean of measured and simulated values together; an exact mean is that of all values."""
    return predicted if simulated is None else (count * measured + simulated * predicted) / (count + simulated)


def _by_chance(low: Fraction | int, mean: Fraction, high: Fraction | int, measured: int, simulated: int | None) -> float:
    """How far means of so many values between two ends are apart by chance.

    By Bernstein's inequality (S. Boucheron, G. Lugosi, P. Massart, Concentration Inequalities, 2013, theorem 2.10), with the greatest
    variance of such values (R. Bhatia, C. Davis, A Better Bound on the Variance, American Mathematical Monthly 107, 2000).
    """
    share = Fraction(1, measured) + (Fraction(1, simulated) if simulated else 0)
    return sqrt(2 * _EXPONENT * (high - mean) * (mean - low) * share) + float((high - low) * share * _EXPONENT / 3)


_UNCERTAIN = "within the uncertainty of the measurement"
