"""Random whole numbers: words are converted to values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np

from amalthea_uros.simulate.sampling.fixed_point import LOWER_HALF, scaled
from amalthea_uros.simulate.sampling.quantile_table import QuantileTable

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Words = NDArray[np.uint64]
    Integers = NDArray[np.int64]


class UnknownValueError(Exception):
    """A distribution does not say which values occur; the text says why."""


class Variate(Protocol):
    """Whole numbers with a distribution; each takes one random word."""

    @property
    def lowest(self) -> int:
        """No value is less."""

    @property
    def highest(self) -> int:
        """No value is greater."""

    def of(self, words: Words) -> Integers:
        """The values for random words."""


@dataclass(frozen=True, slots=True)
class Equal:
    """All whole numbers between two with the same probability, apart from 2**-64."""

    lowest: int
    highest: int

    def of(self, words: Words) -> Integers:
        """See `Variate`."""
        return scaled(words, self.highest - self.lowest + 1).view(np.int64) + np.int64(self.lowest)


@dataclass(frozen=True, slots=True)
class Shaped:
    """Between two numbers with a quantile function.

    A value is rounded up or down at random, so that its mean is that of the exact one, also for small numbers.
    """

    lowest: int
    highest: int
    table: QuantileTable

    def of(self, words: Words) -> Integers:
        """See `Variate`."""
        found = scaled(self.table.fractions(words), self.highest - self.lowest, dither=words & LOWER_HALF)
        return found.view(np.int64) + np.int64(self.lowest)


@dataclass(frozen=True, slots=True)
class Measured:
    """In one of some intervals, each with a weight; all whole numbers in an interval have the same probability.

    Attributes
    ----------
    starts, spans : the least value of each interval, and how many there are
    ends : the sum of the weights up to each interval
    """

    starts: Integers
    spans: Words
    ends: Words

    @property
    def lowest(self) -> int:
        """See `Variate`."""
        return int(self.starts.min())

    @property
    def highest(self) -> int:
        """See `Variate`."""
        return int((self.starts + self.spans.view(np.int64) - 1).max())

    def of(self, words: Words) -> Integers:
        """See `Variate`."""
        total = int(self.ends[-1])
        interval = np.searchsorted(self.ends, scaled(words, total), side="right")
        # The product modulo 2**64 is the fraction that remains within a unit of weight.
        within = words * np.uint64(total)
        return self.starts[interval] + scaled(within, self.spans[interval]).view(np.int64)
