"""Distributions as they are sampled."""

from __future__ import annotations

from fractions import Fraction
from math import isfinite

import numpy as np

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
from amalthea_uros.simulate.sampling.beta import beta_table
from amalthea_uros.simulate.sampling.normal import normal_with_mean, truncated_normal
from amalthea_uros.simulate.sampling.variate import Equal, Measured, Shaped, UnknownValueError, Variate
from amalthea_uros.simulate.sampling.weibull import weibull_table

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
    UnknownValueError : its parameters contradict each other or are out of range.
    """
    check(distribution)
    match distribution:
        case Constant(value):
            return Equal(value, value)
        case Bounds():
            raise UnknownValueError(NO_PARAMETERS)
        case Histogram():
            return _measured(distribution)
        case Gauss(mean=mean, deviation=deviation, lower=lower, upper=upper):
            return truncated_normal(Fraction(mean), deviation, lower, upper)
        case Uniform(lower=lower, upper=upper):
            return Equal(lower, upper)
        case _ if distribution.lower == distribution.upper:
            return Equal(distribution.lower, distribution.upper)
        case Boundaries(lower=lower, upper=upper, sampling=sampling):
            parameters = _PARAMETERS.get(sampling)
            return Shaped(lower, upper, beta_table(*parameters)) if parameters else Equal(lower, upper)
        case Beta(alpha=alpha, beta=beta, lower=lower, upper=upper):
            return Shaped(lower, upper, beta_table(alpha, beta))
        case Statistics(lower=lower, average=average, upper=upper):
            return normal_with_mean(Fraction(average), lower, upper)
        case Weibull(lower=lower, average=average, upper=upper, exceeding=exceeding):
            relative = float((Fraction(average) - lower) / (upper - lower))
            return Shaped(lower, upper, weibull_table(relative, exceeding / 1000))


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
        case Histogram():
            return "all values within an interval of a histogram are equally probable"
    return None


def check(distribution: Distribution[int]) -> None:
    """Refuse contradictory parameters.

    Raises
    ------
    UnknownValueError : they contradict each other or are out of range.
    """
    lower, upper = lowest(distribution), highest(distribution)
    if lower is not None and upper is not None and lower > upper:
        raise UnknownValueError("the minimum of a distribution is greater than its maximum")
    if any(bound is not None and abs(bound) > GREATEST for bound in (lower, upper)):
        raise UnknownValueError("a value of a distribution is out of range")
    match distribution:
        case Statistics(average=average) | Weibull(average=average) if not lower <= average <= upper:  # type: ignore[operator]
            raise UnknownValueError("the average of a distribution is not between its minimum and its maximum")
        case Weibull(average=average, exceeding=exceeding) if lower != upper:
            if average in (lower, upper):
                raise UnknownValueError("the average of a Weibull distribution equals its minimum or its maximum")
            if not 0 < exceeding < 1000:
                raise UnknownValueError(
                    "the probability that a Weibull distribution exceeds its maximum is not between 0 and 1"
                )
        case Gauss(mean=mean, deviation=deviation):
            if not (isfinite(mean) and isfinite(deviation)) or deviation < 0:
                raise UnknownValueError("the mean or the standard deviation of a normal distribution is invalid")
            if abs(mean) + 7 * deviation > GREATEST:
                raise UnknownValueError("a value of a distribution is out of range")
        case Beta(alpha=alpha, beta=beta):
            if not all(_LEAST_PARAMETER <= parameter <= _GREATEST_PARAMETER for parameter in (alpha, beta)):
                raise UnknownValueError("the parameters of a beta distribution are not between 1e-6 and 1e6")


def _measured(histogram: Histogram[int]) -> Variate:
    buckets = [bucket for bucket in histogram.buckets if bucket.occurrences]
    if not buckets:
        raise UnknownValueError("a histogram has no occurrences")
    if any(bucket.occurrences < 0 for bucket in buckets) or any(bucket.lower > bucket.upper for bucket in buckets):
        raise UnknownValueError(
            "an interval of a histogram has a negative number of occurrences or a minimum above its maximum"
        )
    if sum(bucket.occurrences for bucket in buckets) >= GREATEST:
        raise UnknownValueError("the number of occurrences in a histogram is out of range")
    return Measured(
        np.array([bucket.lower for bucket in buckets], np.int64),
        np.array([bucket.upper - bucket.lower + 1 for bucket in buckets], np.uint64),
        np.cumsum(np.array([bucket.occurrences for bucket in buckets], np.uint64)),
    )
