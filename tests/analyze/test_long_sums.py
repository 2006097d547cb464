"""Sums that do not fit into 64 bits do not wrap."""

import pytest

from amalthea_uros.analyze.response_times import priority_levels
from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.task import Task
from amalthea_uros.timing.event_models import Pattern, Periodic
from amalthea_uros.timing.multiframe import Frame, MultiframeDemand


@pytest.mark.parametrize("distinct", [0, 1], ids=["one row", "a row for each task"])
def test_sums_do_not_wrap(distinct):
    # More than 2^64 together, though each job comes so seldom that the load is small.
    longest = 2**54
    tasks = [
        Task(
            name=str(number),
            events=Periodic(2**40 + distinct * number),
            demand=MultiframeDemand((Frame(worst=longest, best=longest, prescaler=2**30),)),
            priority=1 + number,
        )
        for number in range(1030)
    ]
    last = Task(name="last", events=Periodic(2**59), demand=MultiframeDemand.constant(1))
    *_, response = priority_levels.response_times([*tasks, last])
    assert response.worst is None
    assert response.best == 1
    assert Interference.of(tasks).in_window(1) == 1030 * longest


def test_a_fixed_demand_beyond_all_limits():
    often = Task(name="often", events=Pattern(1, (0,)), demand=MultiframeDemand.constant(2**54))
    assert Interference.of([often]).window(1, 2**40) is None
