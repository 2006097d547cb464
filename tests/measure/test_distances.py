"""How much two samples differ: the two-sample Kolmogorov-Smirnov distance and quantiles."""

from fractions import Fraction
from random import Random

import numpy as np
import pytest

from amalthea_uros import InvalidArgumentError
from amalthea_uros.measure.distances import distance


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
