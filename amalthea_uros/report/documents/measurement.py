"""A measurement as a document: the times, what was subtracted, and what could not be used."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from fractions import Fraction
from itertools import islice
from math import floor

from amalthea_uros._internal.plural import counted
from amalthea_uros.compare.calibration.calibration import Calibration
from amalthea_uros.compare.calibration.values import CalibratedValue, Outcome
from amalthea_uros.measure.series import Counts, Measurement, Series
from amalthea_uros.report.basics.document import ResultDocument, Sentences, document, section, table
from amalthea_uros.report.documents.simulation import duration_text
from amalthea_uros.report.wording.cells import shortened
from amalthea_uros.simulate.observations import TimeHistogram
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.units import Rounding, Time, rounded_time_text, time_text

#: The numbers that are shown of each series.
_FIGURES = ("~>n", ">min", ">mean", ">max", "~~>std", "~~~~>peak to peak", "~~~>p99", "~~~~~>variance")
COLUMNS = ("object", "quantity", *_FIGURES)
_NET = ("object", "quantity", ">empty (min / mean / max)", ">at least", ">at most")
_PERIODS = ("object", "quantity", ">period", ">largest deviation")
_COUNTS = ("object", ">incomplete", ">lost", ">duplicated", ">reordered", ">lost activations")
P99 = Fraction(99, 100)
_RARE = (JobMetric.WAITING_TIME, JobMetric.POLLING_TIME, JobMetric.PARKING_TIME)
#: With this probability no more exceed the maximum than `exceedance` says, if the values are independent: 1 - 0.05^(1/n) < 3/n.
_RULE_OF_THREE = 3


def row(series: Series) -> tuple[str, ...]:
    """The figures of a series, for `COLUMNS`."""
    found = series.statistics
    std = None if found is None else found.std
    name = (series.name, series.quantity.replace("_", " "))
    if found is None:
        return (*name, "0", *["-"] * (len(COLUMNS) - 3))
    return (
        *name,
        f"{found.count:,}",
        rounded_time_text(found.min, Rounding.DOWN),
        rounded_time_text(found.mean, Rounding.NEAREST),
        rounded_time_text(found.max, Rounding.UP),
        "-" if std is None else _deviation(std),
        rounded_time_text(found.peak_to_peak, Rounding.UP),
        rounded_time_text(found.percentiles[P99], Rounding.UP) if P99 in found.percentiles else "-",
        "-" if found.variance is None else _square(found.variance),
    )


def _deviation(std: float) -> str:
    return rounded_time_text(Fraction(std), Rounding.NEAREST)


def _square(variance: Fraction) -> str:
    """A mean squared deviation, which the thesis calls jitter."""
    return f"{float(variance) / 1e12:.4g} us^2"


def net_rows(measurement: Measurement) -> Iterator[tuple[str, ...]]:
    """Of each series with a baseline: its name, the baseline, and what the net times are within."""
    for series in measurement.series:
        if series.baseline is not None and series.net_range is not None:
            cost, (low, high) = series.baseline, series.net_range
            spread = f"{time_text(cost.min)} / {rounded_time_text(cost.mean, Rounding.NEAREST)} / {time_text(cost.max)}"
            quantity = series.quantity.replace("_", " ")
            yield series.name, quantity, spread, rounded_time_text(low, Rounding.DOWN), rounded_time_text(high, Rounding.UP)


def period_rows(measurement: Measurement) -> Iterator[tuple[str, ...]]:
    """Of each series of distances with a standard period: its name, the period, and the largest deviation."""
    for series in measurement.series:
        if series.period is not None and series.period_deviation is not None:
            quantity = series.quantity.replace("_", " ")
            deviation = rounded_time_text(series.period_deviation, Rounding.UP)
            yield series.name, quantity, time_text(series.period), deviation


def count_rows(measurement: Measurement) -> Iterator[tuple[str, ...]]:
    """Of each object with events that gave no value: how many of which kind."""
    seen, none = set(), Counts()
    for series in measurement.series:
        if series.name not in seen and series.counts != none:
            seen.add(series.name)
            counts = series.counts
            numbers = (counts.incomplete, counts.lost, counts.duplicated, counts.reordered, counts.lost_activations)
            yield series.name, *(f"{number:,}" for number in numbers)


def methods(measurement: Measurement) -> Iterator[str]:
    """How each object was measured, once for each way."""
    found: dict[str, dict[str, None]] = {}
    for series in measurement.series:
        if series.quantity != "start_to_start":
            found.setdefault(series.method, {})[series.name] = None
    for method, names in found.items():
        if method:
            yield f"{', '.join(islice(names, 3))}{f' and {len(names) - 3} more' if len(names) > 3 else ''}: {method}"


def closing_line(measurement: Measurement) -> str:
    """What was measured, and what its maxima are not."""
    objects = dict.fromkeys(series.name for series in measurement.series if series.statistics is not None)
    if not objects:
        return f"Nothing was measured in {measurement.source}."
    over = f" over {duration_text(measurement.duration)}" if measurement.duration else ""
    what = f"Measured {counted(len(objects), 'object')}{over}"
    return f"{what}. A maximum is the longest time seen, not a bound{_exceedance(measurement)}."


def _exceedance(measurement: Measurement) -> str:
    """How many later values may exceed a maximum, by the fewest values of an object."""
    first = {series.name: series.statistics for series in reversed(measurement.series) if series.statistics is not None}
    count = min(found.count for found in first.values())
    share = exceedance(count)
    if share is None:
        return ""
    return f"; if values are independent, at most 1 in {floor(1 / share):,} exceeds it (n = {count:,}, 95 % confidence)"


def exceedance(count: int) -> Fraction | None:
    """The share of values that may exceed the maximum of so many, with 95 % confidence; None: too few values to say.

    The rule of three: Hanley and Lippman-Hand, JAMA 249 (1983) 1743; Eypasch and others, BMJ 311 (1995) 619.
    """
    return Fraction(_RULE_OF_THREE, count) if count > _RULE_OF_THREE else None


def histogram_of(series: Series, resolution: Time | None) -> TimeHistogram | None:
    """The numbers of values in bins, as of simulations; None if the values are not known.

    Parameters
    ----------
    resolution : the step of the clock, which no bin is narrower than
    """
    if series.values is None or not len(series.values):
        return None
    from amalthea_uros.simulate.metrics.distributions import BinCounts

    counts = BinCounts(unit=resolution or 1)
    counts.add(series.values, int(series.values.min()), int(series.values.max()))
    return TimeHistogram(
        start=Fraction(counts.first * counts.width), width=Fraction(counts.width), counts=tuple(counts.counts.tolist())
    )


def trace_text(measurement: Measurement) -> str:
    """What was measured, and the step of its time stamps if that is known."""
    steps = "" if measurement.resolution is None else f", clock steps of {time_text(measurement.resolution)}"
    return f"{measurement.source} ({measurement.format}{steps})"


def rows(measurement: Measurement) -> Iterator[tuple[str, ...]]:
    """The figures of all series, for `COLUMNS`; without states that no job is ever in."""
    for series in measurement.series:
        if series.quantity not in _RARE or series.statistics is None or series.statistics.max:
            yield row(series)


def measurement_document(measurement: Measurement) -> ResultDocument:
    """Tables of the times, of what was subtracted, and of what could not be used, with how it was measured."""
    baselines = "Baselines (their means are subtracted above; single net times are within the last two columns)"
    sections = (
        section("Measured times", table("", COLUMNS, rows(measurement))),
        section(baselines, table("", _NET, net_rows(measurement))),
        section("Deviation from the standard period", table("", _PERIODS, period_rows(measurement))),
        section("Events that gave no value", table("", _COUNTS, count_rows(measurement))),
        section("How", Sentences(list(methods(measurement)))),
    )
    title = f"Measurement of {measurement.source}"
    return document(
        sections, closing_line(measurement), title, f"Measurement of {trace_text(measurement)}", measurement.findings
    )


#: A longer value, such as a histogram, is shown by its beginning.
_LONGEST = 32


def calibration_document(calibration: Calibration) -> ResultDocument:
    """A row for each measured value, and how many are written into the description."""
    titles = ("value", ">samples", ">min", ">mean", ">max", "described", "now", "")
    values = table("", titles, map(_calibrated, calibration.values))
    return document([section("Measured values and the description", values)], calibration_line(calibration))


def calibration_line(calibration: Calibration) -> str:
    """How many values are written, and how many the measurement refutes."""
    values = calibration.values
    numbers = Counter(str(value.outcome) for value in values)
    parts = [f"{numbers[outcome]} {outcome}" for outcome in Outcome if numbers[outcome]]
    refuted = sum(bool(value.refuted) for value in values)
    doubt = f"; the measurement refutes {counted(refuted, 'value')} of the description" if refuted else ""
    return f"{counted(len(values), 'measured value')}: {', '.join(parts) or 'none'}{doubt}"


def _calibrated(value: CalibratedValue) -> tuple[str, ...]:
    statistics = value.statistics
    return (
        value.target,
        f"{statistics.count:,}",
        time_text(statistics.min),
        rounded_time_text(statistics.mean, Rounding.NEAREST),
        time_text(statistics.max),
        shortened(value.before, _LONGEST),
        shortened(value.after, _LONGEST),
        f"{value.outcome}, refuted" if value.refuted else str(value.outcome),
    )
