"""Counts of values in bins, for any number of values of any size."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

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
    counts: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))

    @property
    def width(self) -> int:
        """The width of a bin."""
        return self._width(self.step)

    def add(self, values: NDArray[np.int64], low: int, high: int) -> None:
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
        self._put(before)

    def _put(self, other: BinCounts) -> None:
        """Add counts of bins that are not wider than these, and are covered by them."""
        filled = np.flatnonzero(other.counts)
        np.add.at(self.counts, (filled + other.first) // (self.width // other.width) - self.first, other.counts[filled])
