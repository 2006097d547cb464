"""Tasks that share a priority, and servers: every bound against schedules that are played through, moment by moment."""

from fractions import Fraction
from itertools import product

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from amalthea_uros.analyze.response_times import priority_levels
from amalthea_uros.analyze.response_times.task import AnalysedTask, Supply
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.event_models.models import PeriodicEvents
from amalthea_uros.timing.scheduling.scheduled import EqualPriority


def shared(equal_priority, rows, above=()):
    """Tasks of (period, wcet, deadline or slice) that share a priority, below others of (period, wcet)."""
    higher = [
        AnalysedTask(
            name=f"H{index}", events=PeriodicEvents(period), demand=MultiframeDemand.constant(wcet), priority=1 + index
        )
        for index, (period, wcet) in enumerate(above)
    ]
    lower = [
        AnalysedTask(
            name=f"T{index}",
            events=PeriodicEvents(period),
            demand=MultiframeDemand.constant(wcet),
            equal_priority=equal_priority,
            deadline=last if equal_priority is EqualPriority.EDF else 0,
            slice=last,
        )
        for index, (period, wcet, last) in enumerate(rows)
    ]
    return [*higher, *lower]


def play(tasks, offsets, until, serves=lambda _: True, tie=1):
    """The longest response time of each task, unit of time by unit of time; among equals the first one or (-1) the last one wins."""
    waiting, worst, turn, used = [], [0] * len(tasks), [], 0
    for now in range(until):
        for index, task in enumerate(tasks):
            if now >= offsets[index] and (now - offsets[index]) % task.events.period == 0:
                waiting.append([now, index, task.demand.worst])
                if index not in turn:
                    turn.append(index)
        if not waiting or not serves(now):
            continue
        top = max(tasks[job[1]].priority for job in waiting)
        level = [job for job in waiting if tasks[job[1]].priority == top]
        match tasks[level[0][1]].equal_priority:
            case EqualPriority.FIFO:
                job = min(level, key=lambda job: (job[0], tie * job[1]))
            case EqualPriority.EDF:
                job = min(level, key=lambda job: (job[0] + tasks[job[1]].deadline, tie * job[1], job[0]))
            case EqualPriority.ROUND_ROBIN:
                first = next(index for index in turn if any(job[1] == index for job in level))
                job = min(job for job in level if job[1] == first)
            case EqualPriority.UNKNOWN:
                # One of the orders that are possible.
                job = min(level, key=lambda job: (tie * job[1], job[0]))
        job[2] -= 1
        if job[2] == 0:
            waiting.remove(job)
            worst[job[1]] = max(worst[job[1]], now + 1 - job[0])
        if tasks[job[1]].equal_priority is EqualPriority.ROUND_ROBIN:
            used += 1
            is_done = not any(other[1] == job[1] for other in waiting)
            if used == tasks[job[1]].slice or is_done:
                turn.remove(job[1])
                used = 0
                if not is_done:
                    turn.append(job[1])
    return worst


def load(tasks):
    return sum((task.demand.mean_worst * task.events.rate for task in tasks), Fraction(0))


ROWS = st.lists(st.tuples(st.sampled_from([4, 6, 8, 12]), st.integers(1, 4), st.integers(1, 14)), min_size=1, max_size=3)
ABOVE = st.lists(st.tuples(st.sampled_from([6, 8]), st.integers(1, 2)), max_size=1)
OFFSETS = st.lists(st.integers(0, 11), min_size=4, max_size=4)


@pytest.mark.parametrize("equal_priority", EqualPriority)
@given(rows=ROWS, above=ABOVE, offsets=OFFSETS)
def test_no_schedule_is_worse_than_the_bound(equal_priority, rows, above, offsets):
    tasks = shared(equal_priority, rows, above)
    assume(load(tasks) <= 1)
    for seen, response in zip(play(tasks, offsets, 96), priority_levels.response_times(tasks), strict=True):
        assert seen <= response.worst
        assert sum(response.terms.values()) == response.worst


@pytest.mark.parametrize("equal_priority", [EqualPriority.FIFO, EqualPriority.EDF])
@given(rows=st.lists(st.tuples(st.sampled_from([3, 4, 6]), st.integers(1, 3), st.integers(1, 7)), min_size=2, max_size=2))
def test_some_offsets_reach_the_bound(equal_priority, rows):
    tasks = shared(equal_priority, rows)
    assume(load(tasks) <= 1)
    periods = [range(task.events.period) for task in tasks]
    seen = [play(tasks, offsets, 60, tie=tie) for offsets in product(*periods) for tie in (1, -1)]
    assert [max(of_task) for of_task in zip(*seen, strict=True)] == [r.worst for r in priority_levels.response_times(tasks)]


@given(rows=ROWS, offsets=OFFSETS, budget=st.integers(1, 4), idle=st.integers(0, 4), phase=st.integers(0, 7))
def test_no_schedule_of_a_server_is_worse_than_the_bound(rows, offsets, budget, idle, phase):
    period = budget + idle
    tasks = [
        AnalysedTask(
            name=f"T{index}", events=PeriodicEvents(period * 3), demand=MultiframeDemand.constant(wcet), priority=-index
        )
        for index, (period, wcet, _) in enumerate(rows)
    ]
    assume(load(tasks) < Fraction(budget, period))
    supply = Supply(budget=budget, period=period, wait=2 * idle)
    # The budget comes at the start of the first period and at the end of all others.
    start = (-phase) % period

    def serves(now):
        number, at = divmod(now - start, period)
        return at < budget if number <= 0 else at >= idle

    for seen, response in zip(
        play(tasks, offsets, 400, serves), priority_levels.response_times(tasks, supply=supply), strict=True
    ):
        assert seen <= response.worst


def test_slices_keep_one_that_demands_too_much_from_the_others():
    greedy, modest = priority_levels.response_times(shared(EqualPriority.ROUND_ROBIN, [(10, 11, 2), (100, 10, 2)]))
    assert greedy.worst is None
    # Five slices of its own, and one of the other before each.
    assert modest.worst == 20


@pytest.mark.parametrize("equal_priority", EqualPriority)
def test_overload_has_a_reason(equal_priority):
    first, _ = priority_levels.response_times(shared(equal_priority, [(10, 6, 5), (10, 5, 5)]))
    assert first.worst is None
    assert "110.0 %" in first.reason
