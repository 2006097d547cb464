"""The demand of rounds that follow each other with a sleep in between, against all rounds of some lengths."""

from itertools import product

import pytest

from amalthea_uros.executors.semantics.loops import lost_periods, next_expiration, workload
from amalthea_uros.perf.executors import Executor, LoopKind, ThreadLoop
from amalthea_uros.timing.event_models.models import PeriodicEvents

LONGEST = 3


@pytest.mark.parametrize("sleep", [1, 2, 5])
def test_no_rounds_demand_more_than_those_of_the_longest(sleep):
    executor = Executor(name="e", task="t", spin="s", loop=ThreadLoop(kind=LoopKind.SLEEPING, timeout=0, sleep=sleep))
    model = workload(executor, PeriodicEvents(1), LONGEST)
    for lengths in product(range(LONGEST + 1), repeat=5):
        begin, demand = 0, 0
        for length in lengths:
            demand += length
            # The window is just longer than the time at which this round begins.
            assert demand <= LONGEST * model.eta_plus(begin + 1)
            begin += length + sleep


def test_without_a_sleep_it_is_what_begins_rounds():
    executor = Executor(name="e", task="t", spin="s", loop=ThreadLoop(kind=LoopKind.CONTINUOUS, timeout=5))
    assert workload(executor, PeriodicEvents(7), LONGEST) == PeriodicEvents(7)


@pytest.mark.parametrize(("called", "lost", "following"), [(30, 0, 40), (39, 0, 40), (40, 1, 50), (58, 2, 60)])
def test_missed_periods_are_lost_and_the_grid_is_kept(called, lost, following):
    # Due at 30, every 10.
    assert lost_periods(called - 30, 10) == lost
    assert next_expiration(30, called, 10) == following
