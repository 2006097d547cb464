"""Weibull distributions, given by a mean and the probability that an upper bound is exceeded."""

from __future__ import annotations

from itertools import count, pairwise, takewhile
from math import lgamma, log

import numpy as np

from amalthea_uros.simulate.sampling.quantile_table import QuantileTable, tabulated
from amalthea_uros.simulate.sampling.roots import root
from amalthea_uros.simulate.sampling.variate import UnknownValueError

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
    UnknownValueError : no such distribution has this mean and this probability.
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
    raise UnknownValueError("no Weibull distribution has the stated average and probability of exceeding the maximum")
