"""MetricDistributions of several quantities that are observed together, such as the times of each job of a process.

Everything is exact, so that it does not depend on how the observations are divided into chunks; squares are those of deviations from
the first value, which are small.
"""

from __future__ import annotations

from fractions import Fraction
from math import sqrt

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros._internal.exact_sums import sums, sums_of_squares
from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.simulate.observations import MetricObservation, ObservedOccurrence, TimeHistogram

#: There are never more bins.
MAX_BINS = 1024


@dataclass(slots=True)
class BinCounts:
    """Counts in bins of equal width.

    The width is the smallest of 1, 2, 10, 20, 100, 200, ... units with which all values are in at most `MAX_BINS` bins. Each of these
    divides the next one, so that bins merge exactly when a value is too far away; widths of 5, 50, ... would not (2 does not divide
    5). The counts depend on the values only, not on the order in which they come.

    Attributes
    ----------
    unit : the smallest width that is useful
    step : number of the width, from 0 for the unit
    first : number of the first bin, which starts at first * width; it contains the smallest value
    counts : of the bins from the first one to that of the greatest value
    """

    unit: int = 1
    step: int = 0
    first: int = 0
    counts: Numbers = field(default_factory=lambda: np.zeros(0, np.int64))

    @property
    def width(self) -> int:
        """The width of a bin."""
        return self._width(self.step)

    def add(self, values: Numbers, low: int, high: int) -> None:
        """Count values.

        Parameters
        ----------
        low, high : the minimum and the maximum of all values, these and earlier ones
        """
        self._cover(low, high)
        self.counts += np.bincount(values // self.width - self.first, minlength=len(self.counts))

    def merge(self, other: BinCounts, low: int, high: int) -> None:
        """Add the counts of another one; `low` and `high` are the minimum and the maximum of the values of both."""
        self._cover(low, high)
        self._put(other)

    def _width(self, step: int) -> int:
        tens, is_double = divmod(step, 2)
        return self.unit * (1 + is_double) * int("1" + tens * "0")

    def _cover(self, low: int, high: int) -> None:
        """Have bins for all values from `low` to `high`."""
        step = self.step
        while high // self._width(step) - low // self._width(step) >= MAX_BINS:
            step += 1
        first, last = low // self._width(step), high // self._width(step)
        size = last - first + 1
        if (step, first, size) == (self.step, self.first, len(self.counts)):
            return
        before = replace(self)
        self.step, self.first, self.counts = step, first, np.zeros(size, np.int64)
        if len(before.counts):
            self._put(before)

    def _put(self, other: BinCounts) -> None:
        """Add counts of bins that are not wider than these, and are covered by them."""
        filled = np.flatnonzero(other.counts)
        np.add.at(self.counts, (filled + other.first) // (self.width // other.width) - self.first, other.counts[filled])


@dataclass(slots=True, kw_only=True)
class MetricDistributions:
    """The distributions of some quantities; each observation has one value of each.

    Attributes
    ----------
    size : number of quantities
    base : time units in a picosecond
    with_histograms : the quantities of which histograms are kept
    count : number of observations
    minima, maxima : of each quantity
    totals : exact sums
    lowest, highest : the observations with the minima and the maxima, the first ones of these: instance, time
    """

    size: int
    base: int
    with_histograms: tuple[int, ...]
    count: int = 0
    minima: Numbers = field(init=False)
    maxima: Numbers = field(init=False)
    totals: list[int] = field(init=False)
    lowest: list[tuple[int, int]] = field(init=False)
    highest: list[tuple[int, int]] = field(init=False)
    _histograms: dict[int, BinCounts] = field(init=False)
    _reference: Numbers = field(init=False)
    _squares: list[int] = field(init=False)

    def __post_init__(self) -> None:
        limits = np.iinfo(np.int64)
        self.minima = np.full(self.size, limits.max)
        self.maxima = np.full(self.size, limits.min)
        self.totals = [0] * self.size
        self.lowest, self.highest = [(0, 0)] * self.size, [(0, 0)] * self.size
        # Bins that are narrower than a picosecond could not be told apart.
        self._histograms = {index: BinCounts(unit=self.base) for index in self.with_histograms}
        self._squares = [0] * self.size

    def add(self, values: Numbers, instances: Numbers, times: Numbers) -> None:
        """Take observations in.

        Parameters
        ----------
        values : a row for each quantity, a column for each observation
        instances, times : of each observation
        """
        if values.shape[1] == 0:
            return
        if self.count == 0:
            self._reference = values[:, 0].copy()
        self.count += values.shape[1]
        self._note_extremes(values, instances, times)
        self.totals = [total + more for total, more in zip(self.totals, sums(values), strict=True)]
        self._add_squares(values - self._reference[:, None])
        for index, histogram in self._histograms.items():
            histogram.add(values[index], int(self.minima[index]), int(self.maxima[index]))

    def merge(self, other: MetricDistributions) -> None:
        """Take the observations of another one in."""
        if other.count == 0:
            return
        if self.count == 0:
            self._reference = other._reference.copy()
        # The squares of the other one, about the reference of this one.
        for index, reference in enumerate(other._reference.tolist()):
            moved = reference - int(self._reference[index])
            deviations = other.totals[index] - other.count * reference
            self._squares[index] += other._squares[index] + 2 * moved * deviations + other.count * moved**2
        self.count += other.count
        self.totals = [one + more for one, more in zip(self.totals, other.totals, strict=True)]
        for index in range(self.size):
            if other.minima[index] < self.minima[index]:
                self.minima[index], self.lowest[index] = other.minima[index], other.lowest[index]
            if other.maxima[index] > self.maxima[index]:
                self.maxima[index], self.highest[index] = other.maxima[index], other.highest[index]
        for index, histogram in self._histograms.items():
            histogram.merge(other._histograms[index], int(self.minima[index]), int(self.maxima[index]))

    def observation(self, index: int) -> MetricObservation | None:
        """What was observed of a quantity, in picoseconds; None if that is nothing."""
        if self.count == 0:
            return None
        mean = Fraction(self.totals[index], self.count)
        variance = Fraction(self._squares[index], self.count) - (mean - int(self._reference[index])) ** 2
        return MetricObservation(
            count=self.count,
            min=Fraction(int(self.minima[index]), self.base),
            mean=mean / self.base,
            max=Fraction(int(self.maxima[index]), self.base),
            std=sqrt(variance) / self.base,
            at_min=self._occurrence(self.lowest[index]),
            at_max=self._occurrence(self.highest[index]),
            histogram=self._histogram(index),
        )

    def _add_squares(self, deviations: Numbers) -> None:
        """Add the squares of deviations, exactly: results must not depend on how observations are divided into chunks."""
        self._squares = [square + more for square, more in zip(self._squares, sums_of_squares(deviations), strict=True)]

    def _note_extremes(self, values: Numbers, instances: Numbers, times: Numbers) -> None:
        for index, low in enumerate(values.min(axis=1).tolist()):
            if low < self.minima[index]:
                where = values[index].argmin()
                self.minima[index], self.lowest[index] = low, (int(instances[where]), int(times[where]))
        for index, high in enumerate(values.max(axis=1).tolist()):
            if high > self.maxima[index]:
                where = values[index].argmax()
                self.maxima[index], self.highest[index] = high, (int(instances[where]), int(times[where]))

    def _occurrence(self, found: tuple[int, int]) -> ObservedOccurrence:
        instance, time = found
        return ObservedOccurrence(instance=instance, time=Fraction(time, self.base))

    def _histogram(self, index: int) -> TimeHistogram | None:
        found = self._histograms.get(index)
        if found is None:
            return None
        width = Fraction(found.width, self.base)
        return TimeHistogram(start=found.first * width, width=width, counts=tuple(found.counts.tolist()))
