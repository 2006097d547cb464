"""Quantiles of beta and Weibull distributions."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from itertools import count, pairwise, takewhile
from math import exp, lgamma, log, log1p

import numpy as np

from amalthea_uros.errors import UnknownError
from amalthea_uros.simulate.sampling.quantile_table import NEGLIGIBLE, POINTS, QuantileTable, quantiles_of_density, tabulated

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
