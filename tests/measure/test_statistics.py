"""Statistics of measured values, against the definitions read literally."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.measure.baselines import without
from amalthea_uros.measure.series import MeasuredKind, Series, merged, shifted, statistics_of

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
