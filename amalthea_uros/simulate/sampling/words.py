"""Random words, the arithmetic of binary fractions, and tables of quantiles: what values are made of, the same on every machine."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from hashlib import blake2b
from itertools import count, pairwise, takewhile
from math import exp, lgamma, log, log1p
from typing import TypeAlias

import numpy as np

from amalthea_uros._internal.arrays import Floats, Words
from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError


class RandomSource:
    """Independent 64-bit words, each value equally probable.

    Philox is a cipher of a counter: its words are the same on every machine, and different keys give independent sequences
    (J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, "Parallel Random Numbers: As Easy as 1, 2, 3", SC 2011).

    Parameters
    ----------
    seed : of the run
    place : what draws, e.g. "stimulus timer"; other places get other words, so that adding one changes no other
    """

    def __init__(self, seed: int, place: str) -> None:
        key = blake2b(f"{seed} {place}".encode(), digest_size=16).digest()
        self._generator = np.random.Philox(key=int.from_bytes(key, "little"))

    def words(self, count: int) -> Words:
        """The next words."""
        return self._generator.random_raw(count)


# Arithmetic of binary fractions: a word of 64 bits stands for its value divided by 2**64, at least 0 and less than 1.

_HALF = np.uint64(32)
#: Selects the lower half of a word.
LOWER_HALF = np.uint64(2**32 - 1)


def scaled(fractions: Words, factor: int | Words, dither: Words | None = None) -> Words:
    """The products of fractions and a number, rounded down.

    Parameters
    ----------
    factor : less than 2**64
    dither : 32 bits each; uniform random ones make the mean of the results that of the exact products. Not for factors from 2**32 on,
        where rounding does not matter
    """
    high, low = fractions >> _HALF, fractions & LOWER_HALF
    if isinstance(factor, int) and factor < 2**32:
        product: Words = high * np.uint64(factor) + (low * np.uint64(factor) >> _HALF)
        if dither is not None:
            product += dither
        product >>= _HALF
        return product
    whole: Words = np.asarray(factor, np.uint64)
    top, bottom = whole >> _HALF, whole & LOWER_HALF
    # None of the sums overflows: a product of two halves leaves room for two more halves.
    middle: Words = high * bottom + (low * bottom >> _HALF)
    lower: Words = low * top + (middle & LOWER_HALF)
    found: Words = high * top + (middle >> _HALF) + (lower >> _HALF)
    return found


# Quantile functions as tables of whole numbers.
#
# The last bit of `exp` or `log` depends on the machine. A table holds the quantiles as whole numbers, rounded so coarsely that such
# differences vanish, and values are drawn from it by integer arithmetic: the same on every machine.


#: Gives the quantiles of probabilities, as fractions of the range of the values.
Quantiles: TypeAlias = "Callable[[Floats], Floats]"

#: Cells of equal probability in a table: 2 to this power.
_CELL_BITS = 10
#: Quantiles are multiples of 2 to the power of minus this; a value between them has 64 bits.
_KNOT_BITS = 28
_REMAINDER_BITS = 64 - _KNOT_BITS
#: How often the outermost cell is divided further: down to probabilities of 2**-30.
_REFINEMENTS = 2

_CELL_SHIFT = np.uint64(64 - _CELL_BITS)
_CELLS = 2**_CELL_BITS


@dataclass(frozen=True, slots=True)
class QuantileTable:
    """A quantile function; between two quantiles, values are equally probable.

    Attributes
    ----------
    knots : the quantiles at the lower ends of the cells
    widths : distance to the next one
    tails : the outermost cells that are divided further, by their number
    """

    knots: Words
    widths: Words
    tails: tuple[tuple[int, QuantileTable], ...]

    def fractions(self, words: Words) -> Words:
        """The quantiles at probabilities; both are binary fractions."""
        cells = words >> _CELL_SHIFT
        places = cells.view(np.int64)
        remainders = (words << np.uint64(_CELL_BITS)) >> np.uint64(64 - _REMAINDER_BITS)
        found = (self.knots.take(places) << np.uint64(_REMAINDER_BITS)) + self.widths.take(places) * remainders
        for cell, tail in self.tails:
            inside = np.flatnonzero(places == cell)
            if len(inside):
                found[inside] = tail.fractions(words[inside] << np.uint64(_CELL_BITS))
        return found


def tabulated(quantiles: Quantiles) -> QuantileTable:
    """The table of a quantile function from [0, 1] to [0, 1]."""
    return _tabulated(quantiles, 0.0, 1.0, (0, _CELLS - 1), _REFINEMENTS)


def _tabulated(quantiles: Quantiles, start: float, width: float, ends: tuple[int, ...], refinements: int) -> QuantileTable:
    """The table of a cell; `ends`: its cells at the ends of the range."""
    # These probabilities have at most 30 bits, so that 1 - p is exact, too.
    probabilities = start + width * np.arange(_CELLS + 1) / _CELLS
    knots = np.rint(quantiles(probabilities) * 2.0**_KNOT_BITS).clip(0, 2**_KNOT_BITS - 1)
    knots = np.maximum.accumulate(knots).astype(np.uint64)
    tails = tuple(
        (end, _tabulated(quantiles, start + width * end / _CELLS, width / _CELLS, (end,), refinements - 1))
        for end in ends
        if refinements
    )
    return QuantileTable(knots[:-1], np.diff(knots), tails)


# Quantiles of a distribution that is given by its density.

#: Where the density is less than exp(-20) of its maximum, a distribution is cut off: a normal one at 6.3 standard deviations.
NEGLIGIBLE = 20.0
#: Points of the integration.
POINTS = 2**14


def quantiles_of_density(points: Floats, logarithms: Floats, values: Floats, ends: tuple[float, float] = (0, 0)) -> Quantiles:
    """The quantiles by the trapezoidal rule, whose error is far below the resolution of a simulation.

    Parameters
    ----------
    points : equidistant
    logarithms : of the density at the points
    values : at the points
    ends : the integral of the density before the first and after the last point
    """
    densities = np.exp(logarithms)
    areas = (densities[1:] + densities[:-1]) * ((points[-1] - points[0]) / (len(points) - 1) / 2)
    integral = np.concatenate(([0.0], np.cumsum(areas))) + ends[0]
    probabilities = integral / (integral[-1] + ends[1])
    return lambda wanted: np.interp(wanted, probabilities, values)


# Beta distributions.

#: Log-odds of a fraction so close to 0 or 1 that a table does not distinguish it.
_FARTHEST = 25.0
_HALVINGS = 60


@cache
def beta_table(alpha: float, beta: float) -> QuantileTable:
    """The quantiles of a beta distribution.

    In the log-odds of a value, the density is smooth and has one maximum for all parameters, also where that of the value is infinite.
    Towards both ends it decreases exponentially, with the rates `alpha` and `beta`.
    """
    peak = min(max(log(alpha / beta), -_FARTHEST), _FARTHEST)
    start = _negligible(lambda t: _logarithm(peak, alpha, beta) - _logarithm(t, alpha, beta), peak, -_FARTHEST)
    end = _negligible(lambda t: _logarithm(peak, alpha, beta) - _logarithm(t, alpha, beta), peak, _FARTHEST)
    points = np.linspace(start, end, POINTS)
    values = 1 / (1 + np.exp(-points))
    logarithms = -alpha * np.logaddexp(0, -points) - beta * np.logaddexp(0, points) - _logarithm(peak, alpha, beta)
    # Beyond the ends, the density decreases like an exponential function.
    before = exp(logarithms[0]) / (alpha - (alpha + beta) * values[0])
    after = exp(logarithms[-1]) / ((alpha + beta) * values[-1] - alpha)
    return tabulated(quantiles_of_density(points, logarithms, values, (before, after)))


def _logarithm(t: float, alpha: float, beta: float) -> float:
    """The logarithm of the density of the log-odds."""
    tail = log1p(exp(-abs(t)))
    return -alpha * (max(-t, 0) + tail) - beta * (max(t, 0) + tail)


def _negligible(decrease: Callable[[float], float], peak: float, farthest: float) -> float:
    """Where the density is negligible, or the farthest point."""
    if decrease(farthest) <= NEGLIGIBLE:
        return farthest
    near, far = peak, farthest
    for _ in range(_HALVINGS):
        middle = (near + far) / 2
        near, far = (middle, far) if decrease(middle) <= NEGLIGIBLE else (near, middle)
    return far


# Weibull distributions, given by a mean and the probability that an upper bound is exceeded.

#: Steps in which the inverse of the shape is searched, and its greatest value: no distribution is wider.
_STEP, _WIDEST = 1 / 16, 20


def weibull_table(average: float, exceeding: float) -> QuantileTable:
    """The quantiles of a Weibull distribution from 0 on, of which values above 1 are rejected.

    Parameters
    ----------
    average : of the distribution with the values above 1
    exceeding : probability of a value above 1

    Raises
    ------
    UnknownError : no such distribution has this mean and this probability.
    """
    logarithm = -log(exceeding)
    inverse_shape = _inverse_shape(average, logarithm)
    # At most 1: exp(-(x / scale)**shape) is the probability of a value above x, and it is `exceeding` for x = 1.
    return tabulated(lambda p: (-np.log1p(-p * (1 - exceeding)) / logarithm) ** inverse_shape)


def _inverse_shape(average: float, logarithm: float) -> float:
    """The inverse of the shape: the mean is scale * Gamma(1 + 1 / shape), and the scale logarithm**(-1 / shape).

    Of two solutions it is the one that is less wide.
    """

    def difference(inverse: float) -> float:
        return lgamma(1 + inverse) - inverse * log(logarithm) - log(average)

    steps = takewhile(lambda inverse: inverse <= _WIDEST, (i * _STEP for i in count()))
    for low, high in pairwise(steps):
        if difference(high) <= 0:
            return root(difference, low, high)
    raise UnknownError("no Weibull distribution has the stated average and probability of exceeding the maximum")


_STEPS = 100


def root(function: Callable[[float], float], low: float, high: float) -> float:
    """Where a function changes its sign between two points, by the Illinois method (M. Dowell, P. Jarratt, BIT 11, 1971)."""
    at_low, at_high = function(low), function(high)
    for _ in range(_STEPS):
        if at_low == at_high:
            break
        middle = high - at_high * (high - low) / (at_high - at_low)
        found = function(middle)
        if found == 0 or abs(high - low) <= 1e-14 * (abs(low) + abs(high)):
            return middle
        if (found < 0) != (at_high < 0):
            low, at_low = high, at_high
        else:
            at_low /= 2
        high, at_high = middle, found
    return high
