"""Means of distributions: they are finite and between the bounds, and equal closed formulas where these are stable."""

from fractions import Fraction
from math import erf, exp, pi, sqrt

import pytest
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.perf.distributions import (
    Beta,
    Boundaries,
    Bucket,
    Constant,
    Gauss,
    Histogram,
    Statistics,
    Uniform,
    Weibull,
    highest,
    lowest,
)
from amalthea_uros.timing.demand.means import exact_sum, mean

ANY_NUMBER = st.floats(allow_nan=True, allow_infinity=True)
BOUNDS = st.tuples(st.integers(0, 10**20), st.integers(0, 10**20)).map(sorted)


def between(bounds, cls, **more):
    return st.builds(lambda values, **others: cls(lower=values[0], upper=values[1], **others), bounds, **more)


DISTRIBUTIONS = st.one_of(
    st.builds(Constant, st.integers(0, 10**20)),
    between(BOUNDS, Boundaries),
    between(BOUNDS, Uniform),
    between(BOUNDS, Statistics, average=ANY_NUMBER),
    between(BOUNDS, Weibull, average=ANY_NUMBER, exceeding=ANY_NUMBER),
    between(BOUNDS, Beta, alpha=ANY_NUMBER, beta=ANY_NUMBER),
    between(BOUNDS, Gauss, mean=ANY_NUMBER, deviation=ANY_NUMBER),
    between(
        st.tuples(st.integers(0, 1000), st.integers(0, 1000)).map(sorted),
        Gauss,
        mean=st.floats(-(10**6), 10**6),
        deviation=st.floats(0, 10**6),
    ),
    st.lists(between(BOUNDS, Bucket, occurrences=st.integers(0, 5)), min_size=1, max_size=4).map(
        lambda buckets: Histogram(tuple(buckets))
    ),
)


@given(DISTRIBUTIONS)
def test_a_mean_is_between_the_bounds(distribution):
    assert lowest(distribution) <= mean(distribution) <= highest(distribution)


def density(x):
    return exp(-x * x / 2) / sqrt(2 * pi)


def below(x):
    return (1 + erf(x / sqrt(2))) / 2


@given(st.integers(-30, 30), st.integers(-30, 30))
def test_near_the_mean_it_is_the_textbook_formula(one, other):
    lower, upper = sorted((one, other))
    if lower == upper:
        upper += 1
    a, b = lower / 10, upper / 10
    expected = 10 * (density(a) - density(b)) / (below(b) - below(a))
    assert float(mean(Gauss(mean=0.0, deviation=10.0, lower=lower, upper=upper))) == pytest.approx(expected, abs=1e-9)


def test_without_bounds_it_is_the_mean_itself():
    assert float(mean(Gauss(mean=7.5, deviation=3.0))) == pytest.approx(7.5, abs=1e-9)
    # Half of a normal distribution: sigma sqrt(2 / pi) above the middle.
    assert float(mean(Gauss(mean=5.0, deviation=3.0, lower=5))) == pytest.approx(5 + 3 * sqrt(2 / pi), abs=1e-9)


@pytest.mark.parametrize("bound", [20, 50, 1000])
def test_in_the_far_tail_it_is_the_asymptotic_series_of_the_hazard_rate(bound):
    # E[x | x > a] = phi(a) / Q(a), and Q(a) = phi(a) (1/a - 1/a^3 + 3/a^5 - 15/a^7 + ...).
    mills = 1 / bound - 1 / bound**3 + 3 / bound**5 - 15 / bound**7 + 105 / bound**9
    assert float(mean(Gauss(mean=0.0, deviation=1.0, lower=bound))) == pytest.approx(1 / mills, rel=1e-9)
    assert float(mean(Gauss(mean=0.0, deviation=1.0, upper=-bound))) == pytest.approx(-1 / mills, rel=1e-9)


def test_a_load_between_20_and_26_percent_has_a_mean_there():
    # The mean of the normal distribution is 10 standard deviations below the least value.
    assert 20 < mean(Gauss(mean=10.0, deviation=1.0, lower=20, upper=26)) < 20.2


@given(st.lists(st.fractions(max_denominator=12)))
def test_the_sum_of_fractions_is_exact(values):
    assert exact_sum(values) == sum(values, Fraction(0))
    assert isinstance(exact_sum(values), Fraction)
