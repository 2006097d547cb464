"""Optimal priorities and sensitivity, against trying everything."""

from fractions import Fraction
from itertools import permutations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT

from amalthea_uros import pipeline
from amalthea_uros.analyze import levels
from amalthea_uros.analyze.arrivals import Periodic
from amalthea_uros.analyze.assignment import assign
from amalthea_uros.analyze.cost import Cost
from amalthea_uros.analyze.sensitivity import greatest_scale
from amalthea_uros.analyze.settings import Settings
from amalthea_uros.analyze.system import analyze
from amalthea_uros.analyze.task import Task

ROWS = st.lists(st.tuples(st.integers(4, 14), st.integers(0, 8), st.integers(1, 4), st.integers(2, 16)), min_size=1, max_size=4)


def meets(order, tasks, deadlines):
    """Whether an order of indices, lowest priority first, meets all deadlines."""
    ranked = [Task(name=t.name, arrivals=t.arrivals, cost=t.cost, priority=order.index(i)) for i, t in enumerate(tasks)]
    responses = levels.response_times(ranked)
    return all(r.worst is not None and r.worst <= d for r, d in zip(responses, deadlines, strict=True))


@given(ROWS)
def test_there_is_an_assignment_if_and_only_if_one_of_all_orders_is_one(rows):
    tasks = [
        Task(name=str(index), arrivals=Periodic(period, jitter), cost=Cost.constant(cost))
        for index, (period, jitter, cost, _) in enumerate(rows)
    ]
    deadlines = [deadline for *_, deadline in rows]
    found = assign(tasks, deadlines)
    some = any(meets(list(order), tasks, deadlines) for order in permutations(range(len(tasks))))
    assert (found is not None) == some
    if found is not None:
        assert meets(found, tasks, deadlines)


def test_deadline_monotonic_order_is_not_best_with_jitter():
    # The task with the shorter deadline arrives regularly; only below the jittering one both fit.
    tasks = [
        Task(name="regular", arrivals=Periodic(20), cost=Cost.constant(4)),
        Task(name="jittering", arrivals=Periodic(20, 16), cost=Cost.constant(3)),
    ]
    assert assign(tasks, [10, 10]) is not None


@pytest.mark.parametrize("sample", ["bodas-test-advanced", "drive-and-lift"])
def test_the_greatest_scale_is_where_a_verdict_changes(sample):
    system = pipeline.describe(ROOT / "samples" / f"{sample}.yaml").system
    scale = greatest_scale(system)
    assert not analyze(system, Settings(scale=scale)).misses
    assert analyze(system, Settings(scale=scale + Fraction(1, 1000))).misses


def test_the_control_function_of_the_thesis_has_room_for_its_deadline():
    # 29 us may become 1 ms; then the executor and the control function take 25 and 4 of every 29 parts.
    system = pipeline.describe(ROOT / "samples" / "bodas-test-advanced.yaml").system
    assert greatest_scale(system) == Fraction(1000 * 1000 // 29, 1000)
