"""Response times against published examples, independent tools, and brute force."""

import json
from fractions import Fraction
from itertools import pairwise

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from support import SHARED
from unit_player import UnitTask, longest_responses

from amalthea_uros.analyze.response_times import fixed_priority, non_preemptive, priority_levels, schedule
from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.core_schedule import CoreSchedule
from amalthea_uros.analyze.response_times.schedule import PeriodicTask
from amalthea_uros.analyze.response_times.task import AnalysedTask
from amalthea_uros.timing.demand.multiframe import DemandFrame, MultiframeDemand
from amalthea_uros.timing.event_models.models import EventPattern, PeriodicEvents


def vectors(name, accept=lambda case: True):
    path = SHARED / "vectors" / f"{name}.json"
    if not path.exists():
        return [pytest.param(None, marks=pytest.mark.skip("the vectors are not at hand"))]
    return [pytest.param(case, id=case["id"]) for case in json.loads(path.read_text())["cases"] if accept(case)]


def tasks_of(case):
    return [
        AnalysedTask(
            name=task["name"],
            events=PeriodicEvents(task["period"], task.get("jitter", 0)),
            demand=MultiframeDemand.constant(task["wcet"]),
            priority=-task["priority"],
        )
        for task in case["tasks"]
    ]


@pytest.mark.parametrize("case", [*vectors("textbook", lambda case: "tasks" in case), *vectors("rta_random")])
def test_published_and_independent_figures(case):
    tasks = tasks_of(case)
    if "non_preemptive" in case["scheduling"]:
        found = non_preemptive.response_times(tasks, case["bit_time"])
    else:
        found = priority_levels.response_times(tasks, [task.get("blocking", 0) for task in case["tasks"]])
    worst = [response.worst for response in found]
    if case.get("wcrt_measured_from") == "arrival_before_jitter":
        worst = [response + task["jitter"] for response, task in zip(worst, case["tasks"], strict=True)]
    assert worst == case["expected_wcrt"]
    assert [sum(response.terms.values()) for response in found] == [response.worst for response in found]


@pytest.mark.parametrize("case", vectors("textbook", lambda case: case["scheduling"] == "utilization_bound"))
def test_liu_and_layland_1973(case):
    """Up to the bound of theorem 5 any tasks end within their periods, also those that just reach it."""
    count, bound = case["n"], case["expected"]
    # The worst case of the proof: periods in the ratio of 2 ** (1 / n), each wcet the distance to the next period.
    periods = [round(10**9 * 2 ** (index / count)) for index in range(count)]
    wcets = [(then - first) for first, then in pairwise([*periods, 2 * periods[0]])]
    assert sum(wcet / period for wcet, period in zip(wcets, periods, strict=True)) == pytest.approx(bound, rel=1e-8)
    tasks = [fixed(f"t{rank}", *row, -rank) for rank, row in enumerate(zip(periods, wcets, strict=True))]
    responses = priority_levels.response_times(tasks)
    assert all(response.worst <= period for response, period in zip(responses, periods, strict=True))


def fixed(name, period, wcet, priority):
    return AnalysedTask(name=name, events=PeriodicEvents(period), demand=MultiframeDemand.constant(wcet), priority=priority)


def test_lehoczky_1990_has_its_worst_response_at_the_fifth_job():
    _, response = priority_levels.response_times([fixed("t1", 70, 26, 2), fixed("t2", 100, 62, 1)])
    assert (response.worst, response.jobs) == (118, 7)
    assert response.terms["earlier arrival"] == -4 * 100


def test_davis_2007_a_later_frame_waits_longest():
    # The example by which the older analysis is refuted, in bits of 1/125 of a millisecond: 1, 1, 1 ms every 2.5, 3.5, 3.5 ms.
    frames = [fixed("A", 2500, 1000, 3), fixed("B", 3500, 1000, 2), fixed("C", 3500, 1000, 1)]
    assert [response.worst for response in non_preemptive.response_times(frames)] == [2000, 3000, 3500]


@pytest.mark.parametrize("case", vectors("schedules"))
def test_schedules_job_by_job(case):
    tasks = [
        PeriodicTask(
            name=t["name"],
            period=t["period"],
            offset=t["offset"],
            demand=MultiframeDemand.constant(t["wcet"]),
            priority=-t["priority"],
        )
        for t in case["tasks"]
    ]
    found = schedule.schedule(tasks, case["simulated_until"], MultiframeDemand.worst_of)
    columns = [zip(jobs.releases.tolist(), jobs.begins.tolist(), jobs.ends.tolist(), strict=True) for jobs in found]
    assert {task.name: [list(job) for job in jobs] for task, jobs in zip(tasks, columns, strict=True)} == case["jobs"]


def test_overload_is_a_result_with_a_reason():
    tasks = [fixed("high", 10, 6, 2), fixed("low", 10, 5, 1)]
    first, second = priority_levels.response_times(tasks)
    assert (first.worst, second.worst) == (6, None)
    assert "110.0 %" in second.reason
    assert all(response.worst is None for response in non_preemptive.response_times(tasks)[1:])


def test_a_processor_that_is_exactly_full():
    tasks = [fixed("high", 4, 2, 2), fixed("low", 8, 4, 1)]
    assert [response.worst for response in priority_levels.response_times(tasks)] == [2, 8]


TASKS = st.lists(st.tuples(st.sampled_from([4, 5, 6, 8, 10, 12]), st.integers(1, 4), st.integers(0, 3)), min_size=1, max_size=4)


def drawn(rows, jitter=False):
    return [
        AnalysedTask(
            name=str(index),
            events=PeriodicEvents(period, jittered if jitter else 0),
            demand=MultiframeDemand.constant(wcet, max(1, wcet - 1)),
            priority=-index,
        )
        for index, (period, wcet, jittered) in enumerate(rows)
    ]


def load(tasks):
    return sum((task.demand.mean_worst * task.events.rate for task in tasks), Fraction(0))


@given(TASKS)
def test_the_busy_window_is_the_schedule_of_the_critical_instant(rows):
    tasks = drawn(rows)
    assume(load(tasks) <= 1)
    released = [
        PeriodicTask(name=t.name, period=t.events.period, offset=0, demand=t.demand, priority=t.priority) for t in tasks
    ]
    exact = list(CoreSchedule.of(released, with_slices=False).response_times().values())
    bounds = priority_levels.response_times(tasks)
    # PeriodicTask together, the worst moment is the first one (Liu and Layland 1973).
    assert [response.worst for response in bounds] == [response.worst for response in exact]


@given(TASKS, st.lists(st.integers(0, 12), min_size=4, max_size=4))
def test_offsets_never_make_it_worse_than_the_bound(rows, offsets):
    tasks = drawn(rows)
    assume(load(tasks) <= 1)
    released = [
        PeriodicTask(name=t.name, period=t.events.period, offset=offset, demand=t.demand, priority=t.priority)
        for t, offset in zip(tasks, offsets, strict=False)
    ]
    exact = list(CoreSchedule.of(released, with_slices=False).response_times().values())
    until = max(offsets) + 2 * schedule.hyperperiod(released)
    jobs = schedule.schedule(released, until, MultiframeDemand.best_of)
    for one, bound, best in zip(exact, priority_levels.response_times(tasks), jobs, strict=True):
        assert one.worst <= bound.worst
        # Once all tasks have started, and what was released before has ended.
        assert bound.best <= (best.ends - best.releases)[best.releases >= until / 2].min()


@given(TASKS)
def test_more_load_never_shortens_a_response_time(rows):
    tasks = drawn(rows, jitter=True)
    more = [
        AnalysedTask(name=t.name, events=t.events, demand=MultiframeDemand.constant(t.demand.worst + 1), priority=t.priority)
        for t in tasks
    ]
    for less, greater in zip(priority_levels.response_times(tasks), priority_levels.response_times(more), strict=True):
        assert greater.worst is None or (less.worst is not None and less.worst <= greater.worst)


@given(TASKS, st.randoms())
def test_the_order_of_tasks_does_not_matter(rows, random):
    tasks = drawn(rows, jitter=True)
    shuffled = random.sample(tasks, len(tasks))
    for analysis in (priority_levels.response_times, non_preemptive.response_times):
        by_name = {task.name: response for task, response in zip(tasks, analysis(tasks), strict=True)}
        assert {task.name: response for task, response in zip(shuffled, analysis(shuffled), strict=True)} == by_name


@given(TASKS)
def test_no_schedule_without_interruption_is_worse_than_its_bound(rows):
    tasks = drawn(rows)
    assume(load(tasks) < 1)
    rows = [UnitTask(task.events.period, task.demand.worst, rank=-task.priority, is_preemptive=False) for task in tasks]
    seen = longest_responses(rows, 240)
    for observed, bound in zip(seen, non_preemptive.response_times(tasks), strict=True):
        assert observed <= bound.worst


class TestDemandThatIsNotTheSameInEachJob:
    """The executor that takes 12 us, and every 20th time 13 more."""

    EXECUTOR = MultiframeDemand((DemandFrame(worst=12, best=12), DemandFrame(worst=13, best=13, prescaler=20)))

    def test_it_is_not_a_25_us_task(self):
        low = fixed("low", 10_000, 1000, 1)
        executor = AnalysedTask(name="executor", events=PeriodicEvents(1000), demand=self.EXECUTOR, priority=2)
        _, response = priority_levels.response_times([executor, low])
        # Two activations in the window of 1,037 us, of which one takes a message.
        assert response.worst == 1000 + 2 * 12 + 13

    @given(st.integers(1, 6), st.integers(1, 5), st.integers(1, 60))
    def test_no_sequence_of_jobs_costs_more(self, prescaler, extra, count):
        demand = MultiframeDemand((DemandFrame(worst=3, best=2), DemandFrame(worst=extra, best=extra, prescaler=prescaler)))
        windows = [range(first, first + count) for first in range(1, 2 * prescaler + 1)]
        assert max(sum(map(demand.worst_of, jobs)) for jobs in windows) == demand.max_demand(count)
        assert min(sum(map(demand.best_of, jobs)) for jobs in windows) == demand.min_demand(count)


# Sums that do not fit into 64 bits do not wrap.


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


DISTINCT = {"a row for each task": 1, "one row": 0}


@pytest.mark.parametrize("distinct", DISTINCT.values(), ids=DISTINCT.keys())
def test_sums_of_a_window_do_not_wrap(distinct):
    assert Interference.of(seldom(distinct)).in_window(1) == 1030 * LONGEST


@pytest.mark.parametrize("distinct", DISTINCT.values(), ids=DISTINCT.keys())
def test_response_times_do_not_wrap(distinct):
    last = AnalysedTask(name="last", events=PeriodicEvents(2**59), demand=MultiframeDemand.constant(1))
    response, _ = fixed_priority.response_time(last, Interference.of(seldom(distinct)))
    assert response.worst is None
    assert response.best == 1


def test_a_fixed_demand_beyond_all_limits():
    often = AnalysedTask(name="often", events=EventPattern(1, (0,)), demand=MultiframeDemand.constant(2**54))
    assert Interference.of([often]).window(1, 2**40) is None


@pytest.mark.parametrize("periods", [(2**50,), (2**50, 2**50), (2**50, 2**51)])
def test_a_demand_that_does_not_fit_into_64_bits(periods):
    """Such as that of callbacks of a host, of which the core has no response times."""
    endless = [
        AnalysedTask(name=str(number), events=PeriodicEvents(period), demand=MultiframeDemand.constant(2**70))
        for number, period in enumerate(periods)
    ]
    interference = Interference.of(endless)
    assert interference.in_window(1) == len(periods) * 2**70
    assert interference.window(1, 1) is None
