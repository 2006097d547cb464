"""Tasks that share a priority, and servers: every bound against schedules that are played through, moment by moment."""

from collections import deque
from fractions import Fraction
from itertools import product
from typing import NamedTuple

import pytest
from effort import examples
from hypothesis import assume, example, given
from hypothesis import strategies as st

from amalthea_uros.analyze.response_times import priority_levels
from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.round_robin import response_time
from amalthea_uros.analyze.response_times.task import AnalysedTask, Supply
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.event_models.derived import AggregatedEventModel
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
            case EqualPriority.ROUND_ROBIN | EqualPriority.TIME_SLICES:
                first = next(index for index in turn if any(job[1] == index for job in level))
                job = min(job for job in level if job[1] == first)
            case EqualPriority.UNKNOWN:
                # One of the orders that are possible.
                job = min(level, key=lambda job: (tie * job[1], job[0]))
        job[2] -= 1
        if job[2] == 0:
            waiting.remove(job)
            worst[job[1]] = max(worst[job[1]], now + 1 - job[0])
        if tasks[job[1]].equal_priority in (EqualPriority.ROUND_ROBIN, EqualPriority.TIME_SLICES):
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
        if equal_priority is EqualPriority.TIME_SLICES and response.worst is None:
            assert response.reason
            assert not response.is_overload
        else:
            assert seen <= response.worst
            assert sum(response.terms.values()) == response.worst


def play_division(tasks, offsets, phase, until):
    """The longest response time of each task if a slice that its task does not need is lost."""
    slots = [index for index, task in enumerate(tasks) for _ in range(task.slice)]
    waiting, worst = [[] for _ in tasks], [0] * len(tasks)
    for now in range(until):
        for jobs, task, offset in zip(waiting, tasks, offsets, strict=False):
            if now >= offset and (now - offset) % task.events.period == 0:
                jobs.append([now, task.demand.worst])
        owner = slots[(now + phase) % len(slots)]
        if waiting[owner]:
            waiting[owner][0][1] -= 1
            if not waiting[owner][0][1]:
                worst[owner] = max(worst[owner], now + 1 - waiting[owner].pop(0)[0])
    return worst


@given(
    rows=st.lists(st.tuples(st.sampled_from([8, 12, 24]), st.integers(1, 4), st.integers(1, 4)), min_size=2, max_size=3),
    offsets=OFFSETS,
    phase=st.integers(0, 11),
)
@example(rows=[(24, 4, 2), (24, 1, 3)], offsets=[2, 0, 0, 0], phase=0)  # just after its slice: two slices of 3 before the end
def test_no_division_of_time_is_worse_than_the_bound(rows, offsets, phase):
    tasks = shared(EqualPriority.TIME_SLICES, rows)
    for seen, response in zip(play_division(tasks, offsets, phase, 96), priority_levels.response_times(tasks), strict=True):
        assert response.worst is None or seen <= response.worst


def test_a_division_of_time_reaches_the_bound():
    tasks = shared(EqualPriority.TIME_SLICES, [(24, 4, 2), (24, 1, 3)])
    assert play_division(tasks, [2, 0], 0, 96)[0] == priority_levels.response_times(tasks)[0].worst == 4 + 2 * 3


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


@pytest.mark.parametrize("equal_priority", EqualPriority)
def test_overload_has_a_reason(equal_priority):
    first, _ = priority_levels.response_times(shared(equal_priority, [(10, 6, 5), (10, 5, 5)]))
    assert first.worst is None
    assert ("time slices" if equal_priority is EqualPriority.TIME_SLICES else "110.0 %") in first.reason


# Round robin against an independent player that goes from unit to unit, under all readings of what the standard leaves open.


class Row(NamedTuple):
    """A task; the one of high priority shares its level with nobody."""

    period: int
    demand: int
    slice: int
    offset: int = 0
    is_high: bool = False


class Reading(NamedTuple):
    """What is open: whether a preempted slice starts anew, who uses it up at an arrival, and whether a next job goes on in it."""

    starts_anew: bool
    first_in_line: bool
    goes_on: bool


READINGS = [Reading(*choice) for choice in product((False, True), repeat=3)]


class Player:
    """Plays rows from time 0 on."""

    def __init__(self, rows, reading):
        self.rows, self.reading = rows, reading
        self.jobs = [deque() for _ in rows]
        self.queue, self.left = deque(), 0
        self.worst = [0] * len(rows)

    def play(self, until):
        expired = None
        for now in range(until):
            arriving = [n for n, row in enumerate(self.rows) if now >= row.offset and (now - row.offset) % row.period == 0]
            if expired is not None and self.reading.first_in_line:
                self.queue.append(expired)
            for number in arriving:
                self.jobs[number].append([now, self.rows[number].demand])
                if not self.rows[number].is_high and number not in self.queue and number != expired:
                    self.queue.append(number)
            if expired is not None and not self.reading.first_in_line:
                self.queue.append(expired)
            expired = self.unit(now)
        return self.worst

    def unit(self, now):
        """A unit of time; returns who has used up its slice at its end."""
        high = [number for number, row in enumerate(self.rows) if row.is_high and self.jobs[number]]
        if high:
            self.serve(high[0], now)
            if self.reading.starts_anew:
                self.left = 0
            return None
        if not self.queue:
            return None
        number = self.queue[0]
        self.left = self.left or self.rows[number].slice
        is_over = self.serve(number, now)
        self.left -= 1
        if self.left and not is_over:
            return None
        if self.left and self.jobs[number] and self.reading.goes_on:
            return None
        self.left = 0
        self.queue.popleft()
        return number if self.jobs[number] else None

    def serve(self, number, now):
        """Execute a job for a unit; whether it is over then."""
        job = self.jobs[number][0]
        job[1] -= 1
        if not job[1]:
            self.jobs[number].popleft()
            self.worst[number] = max(self.worst[number], now + 1 - job[0])
        return not job[1]


def bounds(rows):
    tasks = [
        AnalysedTask(
            name=str(number),
            events=PeriodicEvents(row.period),
            demand=MultiframeDemand.constant(row.demand),
            priority=int(row.is_high),
            equal_priority=EqualPriority.ROUND_ROBIN,
            slice=row.slice,
        )
        for number, row in enumerate(rows)
    ]
    return [response.worst for response in priority_levels.response_times(tasks)]


HIGH = st.builds(Row, st.integers(2, 12), st.integers(1, 3), st.just(1), st.integers(0, 12), st.just(True))
SHARING = st.lists(
    st.builds(Row, st.integers(3, 30), st.integers(1, 8), st.integers(1, 5), st.integers(0, 30), st.just(False)),
    min_size=2,
    max_size=4,
)


@given(st.one_of(SHARING, st.builds(lambda high, rows: [high, *rows], HIGH, SHARING)))
@examples(60)
# Two jobs of a task are pending at a time, and each begins a slice of its own.
@example([Row(3, 1, 4), Row(30, 8, 1), Row(30, 6, 4)])
def test_no_response_is_longer_than_its_bound(rows):
    found = bounds(rows)
    for reading in READINGS:
        occurring = Player(rows, reading).play(until=120)
        for bound, worst in zip(found, occurring, strict=True):
            assert bound is None or worst <= bound, (reading, occurring, found)


def test_a_preempted_slice_can_start_anew():
    # Each time that the high task comes, the long one gets another whole slice before the short one is served.
    rows = [Row(4, 1, 1, is_high=True), Row(1000, 40, 4), Row(1000, 1, 4, offset=1)]
    starting_anew, going_on = (max(Player(rows, Reading(anew, False, False)).play(200)[2:]) for anew in (True, False))
    assert starting_anew > going_on
    assert bounds(rows)[2] >= starting_anew


def test_a_slice_limits_what_an_overloaded_core_does_to_a_short_task():
    # The long task needs more than all; the short one waits for one slice of it.
    assert bounds([Row(10, 20, 3), Row(10, 2, 2)]) == [None, 5]


@pytest.mark.parametrize("reading", READINGS)
def test_the_player_itself(reading):
    # 2 of A, 3 of B, the last one of A.
    assert Player([Row(100, 3, 2), Row(100, 3, 3)], reading).play(100) == [6, 5]


@pytest.mark.parametrize(("limit", "worst"), [(2, 3 + 3 + 1), (1, 3 + 1)])
def test_each_waiting_job_may_have_a_slice_of_its_own(limit, worst):
    """Two jobs of the other task wait, each of 3 in a slice of 3, if its activation limit allows two; then comes the job of 1."""
    twice = AggregatedEventModel((PeriodicEvents(100), PeriodicEvents(100)))
    other = AnalysedTask(name="other", events=twice, demand=MultiframeDemand.constant(3), slice=3, activation_limit=limit)
    task = AnalysedTask(name="task", events=PeriodicEvents(100), demand=MultiframeDemand.constant(1), slice=1)
    assert response_time(task, [other], Interference.of([])).worst == worst
