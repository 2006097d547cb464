"""Round robin against an independent player that goes from unit to unit, under all readings of what the standard leaves open."""

from collections import deque
from itertools import product
from typing import NamedTuple

import pytest
from effort import examples
from hypothesis import example, given
from hypothesis import strategies as st

from amalthea_uros.analyze.response_times import priority_levels
from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.round_robin import response_time
from amalthea_uros.analyze.response_times.task import AnalysedTask
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.event_models.models import AggregatedEventModel, PeriodicEvents
from amalthea_uros.timing.scheduling.scheduled import EqualPriority


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
