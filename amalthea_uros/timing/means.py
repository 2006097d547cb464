"""The mean of a distribution."""

from __future__ import annotations

from fractions import Fraction
from math import erf, exp, inf, pi, sqrt

from amalthea_uros.perf.distributions import (
    Beta,
    Boundaries,
    Constant,
    Distribution,
    Gauss,
    Histogram,
    Statistics,
    Uniform,
    Weibull,
    highest,
    lowest,
)


def mean(distribution: Distribution[int]) -> Fraction:
    """The mean value; the middle of the bounds for `Boundaries`, or if a parameter is not finite."""
    try:
        return _mean(distribution)
    except (ValueError, OverflowError, ZeroDivisionError):
        return Fraction((lowest(distribution) or 0) + (highest(distribution) or 0), 2)


def _mean(distribution: Distribution[int]) -> Fraction:
    match distribution:
        case Constant(value):
            return Fraction(value)
        case Statistics(average=average) | Weibull(average=average):
            return Fraction(average)
        case Uniform(lower=lower, upper=upper) | Boundaries(lower=lower, upper=upper):
            return Fraction(lower + upper, 2)
        case Beta(alpha=alpha, beta=beta, lower=lower, upper=upper):
            return lower + (upper - lower) * Fraction(alpha) / (Fraction(alpha) + Fraction(beta))
        case Histogram(buckets):
            total = sum(bucket.occurrences for bucket in buckets)
            weighted = sum(Fraction(b.lower + b.upper, 2) * b.occurrences for b in buckets)
            return Fraction(weighted, total) if total else Fraction(0)
        case Gauss():
            return Fraction(_truncated_mean(distribution))


def _truncated_mean(gauss: Gauss[int]) -> float:
    """The mean of a normal distribution between its bounds: mu + sigma (phi(a) - phi(b)) / (Phi(b) - Phi(a))."""
    if gauss.deviation <= 0:
        return float(gauss.mean)
    lower = -inf if gauss.lower is None else (gauss.lower - gauss.mean) / gauss.deviation
    upper = inf if gauss.upper is None else (gauss.upper - gauss.mean) / gauss.deviation
    mass = (erf(upper / sqrt(2)) - erf(lower / sqrt(2))) / 2
    if mass <= 0:
        return float(gauss.mean)
    return gauss.mean + gauss.deviation * (_density(lower) - _density(upper)) / mass


def _density(x: float) -> float:
    return exp(-x * x / 2) / sqrt(2 * pi)
