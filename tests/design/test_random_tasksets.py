"""Random task sets: totals, ranges, the distribution that the papers state, and the same numbers for the same seed."""

from random import Random

import pytest

import amalthea_uros as amuros
from amalthea_uros.units import MILLISECOND as MS


def test_uunifast_is_uniform_over_all_sets():
    # Uniform over the simplex of n shares: each has the mean 1/n, and exceeds half of the total with the probability (1/2)^(n - 1).
    random = Random(7)
    sets = [amuros.uunifast(3, 1.0, random) for _ in range(3000)]
    assert all(sum(each) == pytest.approx(1) and min(each) >= 0 for each in sets)
    for shares in zip(*sets, strict=True):
        assert sum(shares) / 3000 == pytest.approx(1 / 3, abs=0.02)
        assert sum(share > 0.5 for share in shares) / 3000 == pytest.approx(1 / 4, abs=0.03)


def test_sets_for_several_cores():
    found = amuros.uunifast_discard(4, 2.0, seed=3)
    assert sum(found) == pytest.approx(2)
    assert max(found) <= 1


def test_periods():
    periods = amuros.log_uniform_periods(400, "10 ms", "1 s", seed=5)
    assert all(10 * MS <= period.time <= 1000 * MS and period.time % MS == 0 for period in periods)
    # Both decades are equally probable.
    assert sum(period.time < 100 * MS for period in periods) / 400 == pytest.approx(0.5, abs=0.1)
    assert {period.time // MS for period in amuros.automotive_periods(300, seed=1)} <= {1, 2, 5, 10, 20, 50, 100, 200, 1000}


@pytest.mark.parametrize("policy", ["fixed priority", "EDF"])
def test_a_system_has_the_utilization(policy):
    system = amuros.random_taskset(5, 0.7, seed=1, policy=policy)
    assert (
        system == amuros.random_taskset(5, 0.7, seed=1, policy=policy) != amuros.random_taskset(5, 0.7, seed=2, policy=policy)
    )
    tasks = amuros.random_tasks(5, 0.7, seed=1)
    # Each execution time is rounded up by less than a nanosecond, and the shortest period is a millisecond.
    assert 0.7 - 1e-9 <= sum(task.wcet / task.period for task in tasks) < 0.7 + 5e-6


def test_edf_schedules_each_set_whose_utilization_is_at_most_1():
    # Liu and Layland 1973, theorem 7
    for seed in range(5):
        system = amuros.random_taskset(4, 0.9, seed, periods=("5 ms", "50 ms"), policy="EDF")
        assert amuros.analyze(system).summary.schedulable is amuros.Schedulable.YES


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: amuros.uunifast(0, 0.5, 1), "at least one task, not 0"),
        (lambda: amuros.uunifast(3, -0.5, 1), "-0.5 is not a positive number"),
        (lambda: amuros.uunifast_discard(2, 2.5, 1), "use more tasks"),
        (lambda: amuros.log_uniform_periods(2, 10, "1 s", 1), "the number 10 has no unit"),
        (lambda: amuros.log_uniform_periods(2, "10 ms", "5 ms", 1), "not above the longest one"),
    ],
)
def test_wrong_parameters(make, message):
    with pytest.raises(amuros.InvalidArgumentError, match=message):
        make()
