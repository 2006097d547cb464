"""Sums that do not fit into 64 bits do not wrap."""

import pytest

from amalthea_uros.analyze.response_times import fixed_priority
from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.task import AnalysedTask
from amalthea_uros.timing.demand.multiframe import DemandFrame, MultiframeDemand
from amalthea_uros.timing.event_models.models import EventPattern, PeriodicEvents

LONGEST = 2**54


def seldom(distinct):
    """More than 2^64 together, though each job comes so seldom that the load is small."""
    return [
        AnalysedTask(
            name=str(number),
            events=PeriodicEvents(2**40 + distinct * number),
            demand=MultiframeDemand((DemandFrame(worst=LONGEST, best=LONGEST, prescaler=2**30),)),
            priority=1 + number,
        )
        for number in range(1030)
    ]


ROWS = {"a row for each task": 1, "one row": 0}


@pytest.mark.parametrize("distinct", ROWS.values(), ids=ROWS.keys())
def test_sums_of_a_window_do_not_wrap(distinct):
    assert Interference.of(seldom(distinct)).in_window(1) == 1030 * LONGEST


@pytest.mark.parametrize("distinct", ROWS.values(), ids=ROWS.keys())
def test_response_times_do_not_wrap(distinct):
    last = AnalysedTask(name="last", events=PeriodicEvents(2**59), demand=MultiframeDemand.constant(1))
    response, _ = fixed_priority.response_time(last, Interference.of(seldom(distinct)))
    assert response.worst is None
    assert response.best == 1


def test_a_fixed_demand_beyond_all_limits():
    often = AnalysedTask(name="often", events=EventPattern(1, (0,)), demand=MultiframeDemand.constant(2**54))
    assert Interference.of([often]).window(1, 2**40) is None
