"""Counters against a play that counts, job by job."""

from collections import Counter as Tally

import pytest
from hand_made_systems import one_core, ticks
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import Call, Chance, Execute, Group, ProbabilitySwitch
from amalthea_uros.perf.software import Runnable
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.jobs import counters
from amalthea_uros.timing.jobs.counters import composed, first_effect, of_one_in
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import MICROSECOND

JOBS, MANY_JOBS = 120, 60_000


def system(tasks, runnables):
    """Tasks of 1 ms on a core of 1 MHz, the first one with the highest priority; a tick is a microsecond."""
    called = [Runnable(name=name, activities=tuple(body)) for name, body in runnables.items()]
    return one_core(*((name, 1000, body) for name, body in tasks.items()), runnables=called)


def takes_effect(counter, number):
    return number >= max(counter.offset, 1) and (number - counter.offset) % counter.prescaler == 0


def played(tasks, runnables, jobs=JOBS):
    """The ticks of the jobs of each task, all of which are released together and executed in their order."""
    reached = Tally()

    def demand(activities):
        total = 0
        for activity in activities:
            if isinstance(activity, Execute):
                total += activity.demand.ticks.value
            elif isinstance(activity, Group):
                total += demand(activity.activities)
            else:
                reached[id(activity)] += 1
                if activity.counter is None or takes_effect(activity.counter, reached[id(activity)]):
                    total += demand(runnables[activity.runnable])
        return total

    rows = [{name: demand(body) for name, body in tasks.items()} for _ in range(jobs)]
    return {name: [row[name] for row in rows] for name in tasks}


COUNTERS = st.builds(Counter, prescaler=st.integers(1, 6), offset=st.integers(-4, 9))


def calls(names):
    return st.builds(Call, runnable=st.sampled_from(names), counter=st.none() | COUNTERS)


def bodies(names):
    return st.lists(st.one_of(st.integers(1, 3).map(ticks), *([calls(names)] if names else [])), min_size=1, max_size=3)


@st.composite
def structures(draw, names):
    """Tasks and runnables, each of which calls only those that follow it."""
    order = ["A", "B", "C"]
    runnables = {name: draw(bodies(order[index + 1 :])) for index, name in enumerate(order)}
    return {name: draw(bodies(order)) for name in names}, runnables


@given(counter=COUNTERS)
def test_the_occurrences_that_take_effect(counter):
    assert all(counters.takes_effect(counter, number) == takes_effect(counter, number) for number in range(1, 100))
    assert first_effect(counter) == next(number for number in range(1, 100) if takes_effect(counter, number))


@given(outer=COUNTERS, inner=COUNTERS)
def test_nested_counters_are_one_counter(outer, inner):
    passed = [number for number in range(1, 200) if takes_effect(outer, number)]
    expected = {number for index, number in enumerate(passed, start=1) if takes_effect(inner, index)}
    found = composed(outer, inner)
    assert {number for number in range(1, 200) if takes_effect(found, number)} == expected


@given(counter=COUNTERS, count=st.integers(1, 5), data=st.data())
def test_a_counter_seen_by_one_of_several_calls_in_a_job(counter, count, data):
    number = data.draw(st.integers(1, count))
    expected = {job for job in range(1, 80) if takes_effect(counter, (job - 1) * count + number)}
    found = of_one_in(counter, number, count)
    assert {job for job in range(1, 80) if found is not None and takes_effect(found, job)} == expected


@given(structure=structures(["T"]) | structures(["T", "U"]))
def test_the_demand_of_each_job(structure):
    tasks, runnables = structure
    context, executed = TimingContext.of(system(tasks, runnables)), played(tasks, runnables)
    for name, demand in context.demands.items():
        found = [(demand.best_of(job) // MICROSECOND, demand.worst_of(job) // MICROSECOND) for job in range(1, JOBS + 1)]
        if demand.is_certain:
            assert found == [(spent, spent) for spent in executed[name]]
        assert all(best <= spent <= worst for spent, (best, worst) in zip(executed[name], found, strict=True))
        for count in (1, 2, 3, 7):
            most = max(sum(executed[name][first : first + count]) for first in range(JOBS - count))
            assert demand.max_demand(count) >= most * MICROSECOND


@given(structure=structures(["T", "U"]))
def test_an_exact_response_time_occurs(structure):
    tasks, runnables = structure
    analysis, executed = analyze_system(system(tasks, runnables)), response_times(tasks, runnables, JOBS)
    for name, times in executed.items():
        response = analysis[name].response
        assert response.worst >= max(times) * MICROSECOND
        assert response.best <= min(times) * MICROSECOND
        if response.claim is Claim.EXACT and response.worst != max(times) * MICROSECOND:
            # Counters of several calls meet late.
            assert response.worst == max(response_times(tasks, runnables, MANY_JOBS)[name]) * MICROSECOND


def response_times(tasks, runnables, jobs):
    """Those of the jobs of T and of U below it; a job without demand also waits for the core before it ends."""
    executed = played(tasks, runnables, jobs)
    return {"T": executed["T"], "U": [sum(both) for both in zip(executed["T"], executed["U"], strict=True)]}


class TestCallsThatAreFollowed:
    """Counters in runnables: known jobs as long as only one process counts."""

    @pytest.mark.parametrize(
        ("body", "expected"),
        [
            # Every 2nd execution of A; A runs in jobs 3, 6, 9, ...: jobs 6, 12, ...
            ([Call(runnable="A", counter=Counter(prescaler=3))], {6, 12}),
            # Two calls in each job: the second of them is always the even one.
            ([Call(runnable="A"), Call(runnable="A")], set(range(1, 13))),
            # Three calls in each job: executions 2, 4, 6 are in jobs 1, 2, 2.
            ([Call(runnable="A"), Group(activities=(Call(runnable="A"), Call(runnable="A")))], set(range(1, 13))),
        ],
    )
    def test_it_is_known_which_jobs_execute_it(self, body, expected):
        demand = TimingContext.of(
            system({"T": body}, {"A": [Call(runnable="B", counter=Counter(prescaler=2))], "B": [ticks(5)]})
        ).demands["T"]
        assert demand.is_certain
        assert {job for job in range(1, 13) if demand.worst_of(job)} == expected

    def test_two_tasks_that_call_it_can_each_meet_the_counter_in_any_job(self):
        runnables = {"A": [Call(runnable="B", counter=Counter(prescaler=2))], "B": [ticks(5)]}
        # Both call A once per period, so that B runs once per period: always in the job of U, never in that of T.
        analysis = analyze_system(system({"T": [Call(runnable="A")], "U": [Call(runnable="A")]}, runnables))
        response = analysis["T"].response
        assert (response.best, response.worst, response.claim) == (0, 5 * MICROSECOND, Claim.BOUND)

    def test_a_counter_in_a_branch_counts_only_when_it_is_reached(self):
        branch = (Call(runnable="B", counter=Counter(prescaler=2)),)
        body = [ProbabilitySwitch(branches=(Chance(weight=0.5, activities=branch), Chance(weight=0.5, activities=(ticks(1),))))]
        response = analyze_system(system({"T": body}, {"B": [ticks(5)]}))["T"].response
        assert (response.best, response.worst, response.claim) == (0, 5 * MICROSECOND, Claim.BOUND)

    def test_a_branch_that_is_never_taken_is_no_proof_of_the_worst_case(self):
        def claim(weight):
            branches = (Chance(weight=weight, activities=(ticks(5),)), Chance(weight=1.0, activities=(ticks(1),)))
            return analyze_system(system({"T": [ProbabilitySwitch(branches=branches)]}, {}))["T"].response.claim

        assert [claim(0.5), claim(0.0)] == [Claim.EXACT, Claim.BOUND]

    def test_an_offset_below_one_only_shifts(self):
        # -5 mod 4 = 3: jobs 3, 7, 11.
        body = [ticks(1), Call(runnable="B", counter=Counter(prescaler=4, offset=-5))]
        analysis = analyze_system(system({"T": body}, {"B": [ticks(5)]}))
        response = analysis["T"].response
        assert (response.best, response.worst, response.claim) == (1 * MICROSECOND, 6 * MICROSECOND, Claim.EXACT)
