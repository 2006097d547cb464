"""Normal distributions between bounds."""

from __future__ import annotations

from fractions import Fraction
from math import ceil, floor, inf, sqrt

import numpy as np

from amalthea_uros.perf.distributions import Gauss
from amalthea_uros.simulate.sampling.density import NEGLIGIBLE, POINTS, quantiles_of_density
from amalthea_uros.simulate.sampling.quantile_table import tabulated
from amalthea_uros.simulate.sampling.roots import root
from amalthea_uros.simulate.sampling.variate import Equal, Shaped, Variate
from amalthea_uros.timing.demand.means import mean

#: Values with a smaller deviation are equal, as they are whole numbers.
_NO_DEVIATION = 1e-9


def truncated_normal(location: Fraction, deviation: float, lower: int | None, upper: int | None) -> Variate:
    """A normal distribution of which values outside the bounds are rejected.

    All is calculated relative to the most probable value, because a bound far in the tail would cancel all digits.
    """
    peak = location
    if lower is not None:
        peak = max(peak, Fraction(lower))
    if upper is not None:
        peak = min(peak, Fraction(upper))
    if deviation < _NO_DEVIATION:
        value = min(max(round(peak), -inf if lower is None else lower), inf if upper is None else upper)
        return Equal(int(value), int(value))
    # In standard deviations: from the mean to the peak, from the peak to where the density is negligible or the bound.
    distance = float(abs(location - peak)) / deviation
    reach = 2 * NEGLIGIBLE / (sqrt(distance * distance + 2 * NEGLIGIBLE) + distance)
    below = reach if lower is None else min(reach, float(peak - lower) / deviation)
    above = reach if upper is None else min(reach, float(upper - peak) / deviation)
    points = np.linspace(-below, above, POINTS)
    logarithms = -np.abs(points) * (2 * distance + np.abs(points)) / 2
    least, most = floor(peak - Fraction(below * deviation)), ceil(peak + Fraction(above * deviation))
    least = least if lower is None else max(lower, least)
    most = most if upper is None else min(upper, most)
    if least == most:
        return Equal(least, most)
    values = (float(peak - least) + points * deviation) / (most - least)
    return Shaped(least, most, tabulated(quantiles_of_density(points, logarithms, values)))


def normal_with_mean(average: Fraction, lower: int, upper: int) -> Variate:
    """The normal distribution between two bounds that has a mean.

    As INCHRON does, the deviation before truncation is a third of the distance to the farther bound.
    """
    if average in (lower, upper):
        return Equal(int(average), int(average))
    below, above = float(average - lower), float(upper - average)
    deviation = max(below, above) / 3

    def difference(location: float) -> float:
        return float(mean(Gauss(mean=location, deviation=deviation, lower=0, upper=upper - lower))) - below

    # Far outside of the bounds, the distribution is exponential with the mean deviation**2 / distance, and nowhere wider than that.
    variance = deviation * deviation
    location = root(difference, -variance / below, upper - lower + variance / above)
    return truncated_normal(lower + Fraction(location), deviation, lower, upper)
