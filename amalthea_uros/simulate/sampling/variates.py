"""Random whole numbers: distributions as they are sampled, a random word for each value."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import ceil, floor, inf, isfinite, sqrt

import numpy as np

from amalthea_uros._internal.arrays import Numbers, Words
from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.distributions import (
    Beta,
    Boundaries,
    Bounds,
    Constant,
    Distribution,
    Gauss,
    Histogram,
    Sampling,
    Statistics,
    Uniform,
    Weibull,
    highest,
    lowest,
)
from amalthea_uros.simulate.sampling.words import (
    LOWER_HALF,
    NEGLIGIBLE,
    POINTS,
    QuantileTable,
    beta_table,
    quantiles_of_density,
    root,
    scaled,
    tabulated,
    weibull_table,
)
from amalthea_uros.timing.demand.means import mean


@dataclass(frozen=True, slots=True)
class Variate:
    """Whole numbers with a distribution; each takes one random word.

    Attributes
    ----------
    lowest, highest : between which all values are
    of : gives the values for random words
    """

    lowest: int
    highest: int
    of: Callable[[Words], Numbers]


def equally_probable(lowest: int, highest: int) -> Variate:
    """All whole numbers between two with the same probability, apart from 2**-64."""
    return Variate(lowest, highest, lambda words: scaled(words, highest - lowest + 1).view(np.int64) + np.int64(lowest))


def shaped(lowest: int, highest: int, table: QuantileTable) -> Variate:
    """Between two numbers with a quantile function.

    A value is rounded up or down at random, so that its mean is that of the exact one, also for small numbers.
    """

    def of(words: Words) -> Numbers:
        fractions = scaled(table.fractions(words), highest - lowest, dither=words & LOWER_HALF)
        return fractions.view(np.int64) + np.int64(lowest)

    return Variate(lowest, highest, of)


# Distributions as they are sampled.

#: Beta parameters as INCHRON uses them (documentation of its metamodel, TimeDistributionType).
_PARAMETERS = {
    Sampling.BEST_CASE: (0.2, 1.0),
    Sampling.WORST_CASE: (1.0, 0.2),
    Sampling.AVERAGE_CASE: (2.0, 2.0),
    Sampling.CORNER_CASE: (0.2, 0.2),
}
#: Other parameters of beta distributions are not sampled: almost all values would be the same.
_LEAST_PARAMETER, _GREATEST_PARAMETER = 1e-6, 1e6
#: Absolute values up to this, and differences of two of them, fit into 64 bits.
GREATEST = 2**62


NO_PARAMETERS = "of a distribution only the bounds are stated; the modes worst and best need no more"


def variate(distribution: Distribution[int]) -> Variate:
    """The distribution as it is sampled.

    Raises
    ------
    UnknownError : its parameters contradict each other or are out of range.
    """
    check(distribution)
    match distribution:
        case Constant(value):
            return equally_probable(value, value)
        case Bounds():
            raise UnknownError(NO_PARAMETERS)
        case Histogram():
            return _measured(distribution)
        case Gauss(mean=mean, deviation=deviation, lower=lower, upper=upper):
            return truncated_normal(Fraction(mean), deviation, lower, upper)
        case Uniform(lower=lower, upper=upper):
            return equally_probable(lower, upper)
        case _ if distribution.lower == distribution.upper:
            return equally_probable(distribution.lower, distribution.upper)
        case Boundaries(lower=lower, upper=upper, sampling=sampling):
            parameters = _PARAMETERS.get(sampling)
            return shaped(lower, upper, beta_table(*parameters)) if parameters else equally_probable(lower, upper)
        case Beta(alpha=alpha, beta=beta, lower=lower, upper=upper):
            return shaped(lower, upper, beta_table(alpha, beta))
        case Statistics(lower=lower, average=average, upper=upper):
            return normal_with_mean(Fraction(average), lower, upper)
        case Weibull(lower=lower, average=average, upper=upper, exceeding=exceeding):
            relative = float((Fraction(average) - lower) / (upper - lower))
            return shaped(lower, upper, weibull_table(relative, exceeding / 1000))


def sampling_assumption(distribution: Distribution[int] | Distribution[float]) -> str | None:
    """What is assumed about the shape of a distribution that is sampled; None if all is specified."""
    match distribution:
        case Boundaries(lower=lower, upper=upper, sampling=Sampling.DEFAULT) if lower != upper:
            return "values between two boundaries without a sampling type are equally probable"
        case Boundaries(sampling=sampling) if sampling in _PARAMETERS:
            return "sampling types are beta distributions with the parameters that INCHRON uses"
        case Statistics(lower=lower, upper=upper) if lower != upper:
            return "values of which minimum, average and maximum are known have a truncated normal distribution with this mean"
        case Gauss(lower=lower, upper=upper) if lower is None or upper is None:
            return (
                "unbounded normal distributions are cut off at 6.3 standard deviations, and those of execution times also at 0"
            )
        case Histogram(buckets) if any(bucket.lower < bucket.upper for bucket in buckets):
            return "all values within an interval of a histogram are equally probable"
    return None


def check(distribution: Distribution[int]) -> None:
    """Refuse contradictory parameters.

    Raises
    ------
    UnknownError : they contradict each other or are out of range.
    """
    lower, upper = lowest(distribution), highest(distribution)
    if lower is not None and upper is not None and lower > upper:
        raise UnknownError("the minimum of a distribution is greater than its maximum")
    if any(bound is not None and abs(bound) > GREATEST for bound in (lower, upper)):
        raise UnknownError("a value of a distribution is out of range")
    match distribution:
        case Statistics(average=average) | Weibull(average=average) if not lower <= average <= upper:  # type: ignore[operator]
            raise UnknownError("the average of a distribution is not between its minimum and its maximum")
        case Weibull(average=average, exceeding=exceeding) if lower != upper:
            if average in (lower, upper):
                raise UnknownError("the average of a Weibull distribution equals its minimum or its maximum")
            if not 0 < exceeding < 1000:
                raise UnknownError("the probability that a Weibull distribution exceeds its maximum is not between 0 and 1")
        case Gauss(mean=mean, deviation=deviation):
            if not (isfinite(mean) and isfinite(deviation)) or deviation < 0:
                raise UnknownError("the mean or the standard deviation of a normal distribution is invalid")
            if abs(mean) + 7 * deviation > GREATEST:
                raise UnknownError("a value of a distribution is out of range")
        case Beta(alpha=alpha, beta=beta):
            if not all(_LEAST_PARAMETER <= parameter <= _GREATEST_PARAMETER for parameter in (alpha, beta)):
                raise UnknownError("the parameters of a beta distribution are not between 1e-6 and 1e6")


def _measured(histogram: Histogram[int]) -> Variate:
    """In one of some intervals, each with a weight; all whole numbers in an interval have the same probability."""
    buckets = [bucket for bucket in histogram.buckets if bucket.occurrences]
    if not buckets:
        raise UnknownError("a histogram has no occurrences")
    if any(bucket.occurrences < 0 for bucket in buckets) or any(bucket.lower > bucket.upper for bucket in buckets):
        raise UnknownError("an interval of a histogram has a negative number of occurrences or a minimum above its maximum")
    if sum(bucket.occurrences for bucket in buckets) >= GREATEST:
        raise UnknownError("the number of occurrences in a histogram is out of range")
    starts = np.array([bucket.lower for bucket in buckets], np.int64)
    spans = np.array([bucket.upper - bucket.lower + 1 for bucket in buckets], np.uint64)
    ends = np.cumsum(np.array([bucket.occurrences for bucket in buckets], np.uint64))
    total = int(ends[-1])

    def of(words: Words) -> Numbers:
        interval = np.searchsorted(ends, scaled(words, total), side="right")
        # The product modulo 2**64 is the fraction that remains within a unit of weight.
        within = words * np.uint64(total)
        return starts[interval] + scaled(within, spans[interval]).view(np.int64)

    return Variate(min(bucket.lower for bucket in buckets), max(bucket.upper for bucket in buckets), of)


# Normal distributions between bounds.

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
        return equally_probable(int(value), int(value))
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
        return equally_probable(least, most)
    values = (float(peak - least) + points * deviation) / (most - least)
    return shaped(least, most, tabulated(quantiles_of_density(points, logarithms, values)))


def normal_with_mean(average: Fraction, lower: int, upper: int) -> Variate:
    """The normal distribution between two bounds that has a mean.

    As INCHRON does, the deviation before truncation is a third of the distance to the farther bound.
    """
    if average in (lower, upper):
        return equally_probable(int(average), int(average))
    below, above = float(average - lower), float(upper - average)
    deviation = max(below, above) / 3

    def difference(location: float) -> float:
        return float(mean(Gauss(mean=location, deviation=deviation, lower=0, upper=upper - lower))) - below

    # Far outside of the bounds, the distribution is exponential with the mean deviation**2 / distance, and nowhere wider than that.
    variance = deviation * deviation
    location = root(difference, -variance / below, upper - lower + variance / above)
    return truncated_normal(lower + Fraction(location), deviation, lower, upper)
