"""Beta distributions."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import exp, log, log1p

import numpy as np

from amalthea_uros.simulate.sampling.density import NEGLIGIBLE, POINTS, quantiles_of_density
from amalthea_uros.simulate.sampling.quantile_table import QuantileTable, tabulated

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
