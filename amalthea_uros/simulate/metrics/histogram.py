"""Counts of values in bins, for any number of values of any size."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: There are never more bins.
MAX_BINS = 1024


@dataclass(slots=True)
class BinCounts:
    """Counts in bins of equal width.

    The width is the smallest power of two with which all values are in at most `MAX_BINS` bins; it doubles when a value is too far
    away, and pairs of bins become one. The counts depend on the values only, not on the order in which they come.

    Attributes
    ----------
    shift : the width of a bin is 2 ** shift; it is given with the smallest width that is useful
    first : number of the first bin, which starts at first * width; it contains the smallest value
    counts : of the bins from the first one to that of the greatest value
    """

    shift: int = 0
    first: int = 0
    counts: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))

    def add(self, values: NDArray[np.int64], low: int, high: int) -> None:
        """Count values.

        Parameters
        ----------
        low, high : the minimum and the maximum of all values, these and earlier ones
        """
        self._cover(low, high)
        self.counts += np.bincount((values >> self.shift) - self.first, minlength=len(self.counts))

    def merge(self, other: BinCounts, low: int, high: int) -> None:
        """Add the counts of another one; `low` and `high` are the minimum and the maximum of the values of both."""
        self._cover(low, high)
        self._put(other)

    def _cover(self, low: int, high: int) -> None:
        """Have bins for all values from `low` to `high`."""
        shift = self.shift
        while (high >> shift) - (low >> shift) >= MAX_BINS:
            shift += 1
        size = (high >> shift) - (low >> shift) + 1
        if (shift, low >> shift, size) == (self.shift, self.first, len(self.counts)):
            return
        before = BinCounts(self.shift, self.first, self.counts)
        self.shift, self.first, self.counts = shift, low >> shift, np.zeros(size, np.int64)
        self._put(before)

    def _put(self, other: BinCounts) -> None:
        """Add counts of bins that are not wider than these, and are covered by them."""
        filled = np.flatnonzero(other.counts)
        np.add.at(self.counts, ((filled + other.first) >> (self.shift - other.shift)) - self.first, other.counts[filled])
