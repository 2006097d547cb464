"""The mean of a distribution; it lies between the bounds of the distribution."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from functools import cache
from math import exp, sqrt

from amalthea_uros.perf.distributions import (
    Beta,
    Boundaries,
    Bounds,
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

#: Where the density is less than exp(-40) of its maximum, it does not change a mean in double precision.
_NEGLIGIBLE = 40.0
#: Points of the quadrature.
_POINTS = 128


def mean(distribution: Distribution[int]) -> Fraction:
    """The mean value; the middle of the bounds for `Boundaries` and `Bounds`, or if a parameter is not finite."""
    lower, upper = lowest(distribution), highest(distribution)
    try:
        found = _mean(distribution)
    except (ValueError, OverflowError, ZeroDivisionError):
        found = Fraction((lower or 0) + (upper or 0), 2)
    if lower is not None and found < lower:
        found = Fraction(lower)
    return found if upper is None or found <= upper else Fraction(upper)


def exact_sum(values: Iterable[Fraction]) -> Fraction:
    """The sum of fractions, most of which have one of a few denominators; quicker than adding them one by one."""
    numerators: dict[int, int] = {}
    for value in values:
        numerators[value.denominator] = numerators.get(value.denominator, 0) + value.numerator
    return sum((Fraction(numerator, denominator) for denominator, numerator in numerators.items()), Fraction(0))


def _mean(distribution: Distribution[int]) -> Fraction:
    match distribution:
        case Constant(value):
            return Fraction(value)
        case Statistics(average=average) | Weibull(average=average):
            return Fraction(average)
        case Uniform(lower=lower, upper=upper) | Boundaries(lower=lower, upper=upper) | Bounds(lower=lower, upper=upper):
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
    """The mean of a normal distribution between its bounds, by Gauss-Legendre quadrature.

    The closed formula, mu + sigma (phi(a) - phi(b)) / (Phi(b) - Phi(a)), divides 0 by 0 far from the mean. The quadrature is a weighted
    mean of points between the bounds, with weights relative to the greatest density there, so that it is stable everywhere.
    """
    if gauss.deviation <= 0:
        return float(gauss.mean)
    lower = None if gauss.lower is None else (gauss.lower - gauss.mean) / gauss.deviation
    upper = None if gauss.upper is None else (gauss.upper - gauss.mean) / gauss.deviation
    mode = 0.0 if lower is None else max(0.0, lower)
    mode = mode if upper is None else min(mode, upper)
    reach = sqrt(mode * mode + 2 * _NEGLIGIBLE)
    start = -reach if lower is None else max(lower, -reach)
    end = reach if upper is None else min(upper, reach)
    middle, half = (start + end) / 2, (end - start) / 2
    total = weighted = 0.0
    for point, weight in _quadrature():
        x = middle + half * point
        density = weight * exp((mode - x) * (mode + x) / 2)
        total, weighted = total + density, weighted + density * x
    return gauss.mean + gauss.deviation * weighted / total


@cache
def _quadrature() -> list[tuple[float, float]]:
    """Points between -1 and 1, with their weights."""
    from numpy.polynomial.legendre import leggauss

    points, weights = leggauss(_POINTS)
    return list(zip(points.tolist(), weights.tolist(), strict=True))
