"""What was measured of an object: the values of one quantity, their statistics, and how much two samples differ."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import StrEnum
from fractions import Fraction
from functools import lru_cache
from math import ceil, log, sqrt
from typing import Final

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros._internal.shown import Shown
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.units import Time

#: The quantity of a measured time that is of an object as a whole: the response time of a process, the reaction time of a chain.
WHOLE_TIME: Final = "time"
_MEDIAN = Fraction(1, 2)
#: So many values are added sooner one by one than as arrays.
_FEW = 100
#: The percentiles that are computed where all values are known.
PERCENTILES = (_MEDIAN, Fraction(9, 10), Fraction(95, 100), Fraction(99, 100), Fraction(999, 1000))


@dataclass(frozen=True, slots=True, kw_only=True)
class TimeStatistics:
    """Statistics of some values, in picoseconds.

    Attributes
    ----------
    count : number of values, at least 1
    variance : mean squared deviation from the mean (divided by n), in square picoseconds; None if it is not known
    percentiles : share of the values -> least value that so many do not exceed; only where there are more than 1 / (1 - share) values
    """

    count: int
    min: Time
    mean: Fraction
    max: Time
    variance: Fraction | None
    percentiles: Mapping[Fraction, Time] = field(default_factory=dict)

    @property
    def std(self) -> float | None:
        """The standard deviation, divided by n, not n - 1."""
        return None if self.variance is None else sqrt(self.variance)

    @property
    def peak_to_peak(self) -> Time:
        """The jitter as difference between maximum and minimum."""
        return self.max - self.min


#: The public name.
Statistics = TimeStatistics


def statistics_of(values: Numbers) -> TimeStatistics:
    """The statistics of values in picoseconds.

    Raises
    ------
    InvalidArgumentError : there are none.
    """
    if not len(values):
        raise InvalidArgumentError("there are no values, so they have no statistics")
    ordered, total, squares = _of_few(values) if len(values) <= _FEW else _of_many(values)
    count, first = len(ordered), int(ordered[0])
    return TimeStatistics(
        count=count,
        min=first,
        mean=Fraction(first * count + total, count),
        max=int(ordered[-1]),
        variance=Fraction(squares * count - total * total, count * count),
        percentiles={share: int(ordered[place]) for share, place in _places(count)},
    )


@lru_cache
def _places(count: int) -> Sequence[tuple[Fraction, int]]:
    """The percentiles that are computed of so many values, and their places in the order of the values."""
    return [(each, ceil(each * count) - 1) for each in PERCENTILES if each == _MEDIAN or count > 1 / (1 - each)]


def _of_few(values: Numbers) -> tuple[Sequence[int], int, int]:
    """The values in their order, and the sums of their distances from the least one and of the squares of these."""
    ordered = sorted(values.tolist())
    distances = [value - ordered[0] for value in ordered]
    return ordered, sum(distances), sum(distance * distance for distance in distances)


def _of_many(values: Numbers) -> tuple[Numbers, int, int]:
    """The same, by numpy."""
    import numpy as np

    from amalthea_uros._internal.exact_sums import sums, sums_of_squares

    ordered = np.sort(values)
    distances = (ordered - ordered[0])[None, :]
    (total,), (squares,) = sums(distances), sums_of_squares(distances)
    return ordered, total, squares


def statistics_or_none(values: Numbers) -> TimeStatistics | None:
    """The statistics of values in picoseconds, None if there are none."""
    return statistics_of(values) if len(values) else None


def merged(parts: Sequence[TimeStatistics]) -> TimeStatistics:
    """The statistics of all values of some parts, exactly; percentiles do not merge, and the variance only if all are known.

    Parameters
    ----------
    parts : at least one
    """
    count = sum(part.count for part in parts)
    mean = sum((part.mean * part.count for part in parts), Fraction(0)) / count
    variance: Fraction | None = Fraction(0)
    for part in parts:
        if part.variance is None or variance is None:
            variance = None
        else:
            variance += (part.variance + (part.mean - mean) ** 2) * part.count / count
    return TimeStatistics(
        count=count,
        min=min(part.min for part in parts),
        mean=mean,
        max=max(part.max for part in parts),
        variance=variance,
    )


def shifted(statistics: TimeStatistics, by: Time) -> TimeStatistics:
    """The statistics of the values with a time added to each."""
    percentiles = {share: value + by for share, value in statistics.percentiles.items()}
    low, mean, high = statistics.min + by, statistics.mean + by, statistics.max + by
    return replace(statistics, min=low, mean=mean, max=high, percentiles=percentiles)


class MeasuredKind(StrEnum):
    """What times belong to; an interval is one between two markers of which nothing else is known."""

    PROCESS = "process"
    RUNNABLE = "runnable"
    CHAIN = "chain"
    INTERVAL = "interval"


@dataclass(frozen=True, slots=True, kw_only=True)
class Counts:
    """What became of the events of a series that gave no value.

    Attributes
    ----------
    incomplete : intervals without a start or without an end, for example at the edges of the log
    lost : values that gaps in the log, or in numbers that count up, prove to be missing
    duplicated : events that are there more than once
    reordered : events that stand before an earlier one
    lost_activations : activations that became no job, because too many jobs were pending
    """

    incomplete: int = 0
    lost: int = 0
    duplicated: int = 0
    reordered: int = 0
    lost_activations: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Series:
    """The measured values of one quantity of one object.

    Attributes
    ----------
    quantity : by the names of `JobMetric` for processes and runnables, of `ChainQuantity` for chains, `duration` for intervals,
        `time` of an object as a whole
    statistics : None if there is no value
    values : picoseconds, in the order of their occurrence; None if the trace has only their statistics
    times : when each value was complete, in picoseconds from the start of the trace; None if that is not known
    method : how it was measured, in words
    baseline : of the empty object whose mean was subtracted from the values, None if nothing was
    period : the standard period of distances, None if it is not stated
    is_least : whether the real values are at least these: what a response belongs to is not known
    begin : with what a job or a chain of a trace begins: "activation", "start" or "end of the wait"; "" for what markers delimit
    """

    kind: MeasuredKind
    name: str
    quantity: str
    statistics: TimeStatistics | None
    values: Numbers | None = field(default=None, repr=False, compare=False)
    times: Numbers | None = field(default=None, repr=False, compare=False)
    counts: Counts = Counts()
    method: str = ""
    baseline: TimeStatistics | None = None
    period: Time | None = None
    is_least: bool = False
    begin: str = ""

    @property
    def net_range(self) -> tuple[Time, Time] | None:
        """What the values without their share of the baseline are within: [min a - max o, max a - min o]; None without a baseline.

        The share of each value is not known, only that it is within those of the baseline; `statistics` subtracts its mean.
        """
        if self.baseline is None or self.statistics is None:
            return None
        mean = round(self.baseline.mean)
        return self.statistics.min + mean - self.baseline.max, self.statistics.max + mean - self.baseline.min

    @property
    def period_deviation(self) -> Time | None:
        """The jitter of AUTOSAR: the largest deviation from the standard period; None if that is not stated."""
        if self.period is None or self.statistics is None:
            return None
        return max(abs(self.statistics.max - self.period), abs(self.statistics.min - self.period))


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Measurement(Shown):
    """All that was measured in a trace.

    Attributes
    ----------
    source : the file, or what the values come from
    format : of the trace, such as "candump" or "BTF"
    digest : SHA-256 of the files, as hexadecimal digits; "" if there are none
    duration : from the first to the last event
    resolution : smallest step of the time stamps; None if it is not known
    """

    source: str
    format: str
    digest: str = ""
    duration: Time
    resolution: Time | None = None
    series: tuple[Series, ...]
    findings: tuple[Finding, ...] = ()

    def __repr__(self) -> str:
        return f"<Measurement of {self.source}: {len(self.series)} series>"

    def find(self, name: str, quantity: str) -> Series | None:
        """The series of a quantity of an object, None if it was not measured."""
        return next((each for each in self.series if (each.name, each.quantity) == (name, quantity)), None)


# How much two samples differ in distribution: equal means can hide different ones.
#
# The distance is that of the two-sample test of Kolmogorov and Smirnov: the greatest difference between the shares of values that do
# not exceed a time (N. Smirnov, Annals of Mathematical Statistics 19, 1948). Quantiles are values that occurred (nearest rank).


#: How often a greater distance than the critical one occurs by chance, for independent samples of one distribution.
SIGNIFICANCE = 0.05
#: The shares of the quantiles that are compared.
QUANTILES = (Fraction(10, 100), Fraction(50, 100), Fraction(90, 100), Fraction(99, 100))


@dataclass(frozen=True, slots=True, kw_only=True)
class Distance:
    """The difference between the distributions of two samples.

    Attributes
    ----------
    value : the Kolmogorov-Smirnov distance, from 0 (equal) to 1 (no value in common)
    critical : for large independent samples of one distribution, it is greater in 5 % of the cases only
    counts : the numbers of values
    quantiles : share -> the quantiles of both
    """

    value: Fraction
    critical: float
    counts: tuple[int, int]
    quantiles: Mapping[Fraction, tuple[Time, Time]]

    @property
    def is_significant(self) -> bool:
        """Whether chance alone hardly explains it."""
        return self.value > self.critical


def distance(one: Numbers, other: Numbers) -> Distance:
    """The distance of two samples of times.

    Raises
    ------
    InvalidArgumentError : a sample has no values.
    """
    import numpy as np

    counts = len(one), len(other)
    if not all(counts):
        raise InvalidArgumentError("there are no values, so they have no distribution")
    ordered = np.sort(one), np.sort(other)
    # The distribution functions change at values only; whole numbers keep their difference exact.
    places = np.unique(np.concatenate(ordered))
    below = [np.searchsorted(values, places, side="right") for values in ordered]
    greatest = int(np.abs(below[0] * counts[1] - below[1] * counts[0]).max())
    return Distance(
        value=Fraction(greatest, counts[0] * counts[1]),
        critical=sqrt(-log(SIGNIFICANCE / 2) / 2 * (1 / counts[0] + 1 / counts[1])),
        counts=counts,
        quantiles={share: (_quantile(ordered[0], share), _quantile(ordered[1], share)) for share in QUANTILES},
    )


def _quantile(ordered: Numbers, share: Fraction) -> Time:
    return int(ordered[ceil(share * len(ordered)) - 1])
