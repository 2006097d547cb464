"""Statistics of measured values, and how much two samples differ, against the definitions read literally."""

from fractions import Fraction
from random import Random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.measure.baselines import without
from amalthea_uros.measure.series import MeasuredKind, Series, distance, merged, shifted, statistics_of

times = st.integers(-(2**61), 2**61)
lists = st.lists(times, min_size=1, max_size=50)


def figures(values):
    count, mean = len(values), Fraction(sum(values), len(values))
    return count, min(values), mean, max(values), sum((value - mean) ** 2 for value in values) / count


def of(statistics):
    return statistics.count, statistics.min, statistics.mean, statistics.max, statistics.variance


@given(lists)
def test_the_figures_are_exact(values):
    assert of(statistics_of(np.array(values, np.int64))) == figures(values)


@given(st.lists(lists, min_size=1, max_size=5))
def test_parts_merge_to_the_whole(parts):
    found = merged([statistics_of(np.array(part, np.int64)) for part in parts])
    assert of(found) == figures([value for part in parts for value in part])


@given(lists, st.integers(-1000, 1000))
def test_a_shift_moves_all_but_the_spread(values, by):
    assert shifted(statistics_of(np.array(values)), by) == statistics_of(np.array(values) + by)


def test_a_percentile_needs_more_values_than_it_leaves_out():
    """p99 of 100 values is their maximum, and tells nothing."""
    assert Fraction(99, 100) not in statistics_of(np.arange(100)).percentiles
    assert statistics_of(np.arange(1, 1001)).percentiles[Fraction(99, 100)] == 990


def test_no_values_have_no_statistics():
    with pytest.raises(InvalidArgumentError):
        statistics_of(np.empty(0, np.int64))


@given(st.lists(st.integers(0, 10**9), min_size=1), st.lists(st.integers(0, 10**6), min_size=1), st.data())
def test_every_net_time_is_in_the_interval(net, costs, data):
    """Whichever cost each value has, the true net times are within the interval."""
    paid = [data.draw(st.sampled_from(costs)) for _ in net]
    values = np.array([time + cost for time, cost in zip(net, paid, strict=True)])
    series = Series(kind=MeasuredKind.PROCESS, name="T", quantity="duration", statistics=statistics_of(values), values=values)
    low, high = without(series, statistics_of(np.array(costs))).net_range
    assert low <= min(net)
    assert max(net) <= high


def test_the_deviation_from_the_period_is_the_larger_one():
    series = Series(
        kind=MeasuredKind.PROCESS,
        name="T",
        quantity="start_to_start",
        statistics=statistics_of(np.array([987, 1013, 1020])),
        period=1000,
    )
    assert series.period_deviation == 20


def sample(*values):
    return np.array(values, np.int64)


def by_definition(one, other):
    """The greatest difference of the empirical distribution functions, value by value."""

    def share(values, limit):
        return Fraction(sum(value <= limit for value in values), len(values))

    return max(abs(share(one, limit) - share(other, limit)) for limit in {*one, *other})


def test_equal_samples_have_no_distance_and_disjoint_ones_have_1():
    assert distance(sample(1, 2, 2, 3), sample(3, 2, 1, 2)).value == 0
    assert distance(sample(1, 2), sample(3, 4, 5)).value == 1


def test_it_does_not_depend_on_the_order_of_the_samples():
    assert distance(sample(1, 5, 9), sample(2, 5)).value == distance(sample(5, 2), sample(9, 1, 5)).value


def test_random_samples_have_the_distance_of_the_definition():
    random = Random(1)
    for _ in range(50):
        one, other = ([random.randrange(12) for _ in range(random.randrange(1, 30))] for _ in range(2))
        assert distance(sample(*one), sample(*other)).value == by_definition(one, other)


def test_the_critical_value_is_that_of_the_tables():
    # 1.358 * sqrt((n + m) / (n * m)) at 5 %: N. Smirnov 1948, and every table since.
    found = distance(np.zeros(100, np.int64), np.zeros(50, np.int64))
    assert found.critical == pytest.approx(1.358 * (150 / 5000) ** 0.5, rel=1e-3)
    assert not found.is_significant


def test_equal_means_of_different_distributions_are_far_apart():
    # Both have the mean 20: one is always 20, the other 12 or 28.
    found = distance(np.full(200, 20), np.tile([12, 28], 100))
    assert found.value == Fraction(1, 2)
    assert found.is_significant
    assert found.quantiles[Fraction(9, 10)] == (20, 28)


def test_a_sample_without_values_is_refused():
    with pytest.raises(InvalidArgumentError, match="no values"):
        distance(sample(), sample(1))
