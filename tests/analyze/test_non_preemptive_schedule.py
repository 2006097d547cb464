"""Non-preemptive tasks with known releases, against schedules that a simple scheduler makes."""

from dataclasses import replace
from math import lcm

import pytest
from design_systems import system_of
from effort import examples
from hand_made_systems import changed, ticks
from hypothesis import assume, given
from hypothesis import strategies as st
from unit_player import UnitTask, longest_responses

from amalthea_uros.analyze.response_times.non_preemptive_schedule import ASSUMPTION
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import SchedulePoint
from amalthea_uros.perf.distributions import Boundaries
from amalthea_uros.perf.stimuli import Stimuli
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import MICROSECOND as US


def played(tasks):
    """The longest response time of each task, the most important one first."""
    rows = [UnitTask(task["T"], task["C"], task["O"], rank, is_preemptive=False) for rank, task in enumerate(tasks)]
    return longest_responses(rows, max(task["O"] for task in tasks) + 6 * lcm(*(task["T"] for task in tasks)))


@st.composite
def task_sets(draw):
    tasks = []
    for name in "ABCD"[: draw(st.integers(2, 4))]:
        period = draw(st.sampled_from([4, 5, 6, 8, 10, 12]))
        cost, offset = draw(st.integers(1, 4)), draw(st.integers(0, 12))
        # The activation limit that follows from the deadline lets no activation be lost.
        tasks.append({"name": name, "C": cost, "T": period, "O": offset, "D": 10 * period})
    assume(sum(task["C"] / task["T"] for task in tasks) <= 1)
    return tasks


@examples(24)
@given(task_sets())
def test_response_times_are_those_of_the_schedule(tasks):
    analysis = analyze_system(system_of(tasks, [task["name"] for task in tasks], preemptive=False))
    assert [analysis[task["name"]].wcrt // US for task in tasks] == played(tasks)
    assert {process.response.claim for process in analysis.processes} == {Claim.EXACT}
    assert all(sum(process.response.terms.values()) == process.wcrt for process in analysis.processes)
    assert ASSUMPTION in analysis.assumptions


TASKS = [{"name": "A", "C": 2, "T": 10, "O": 1}, {"name": "B", "C": 3, "T": 10, "O": 0}]


def test_a_job_below_goes_on_to_its_end():
    # B executes from 0 to 3, A waits for it from 1 on.
    analysis = analyze_system(system_of(TASKS, "AB", preemptive=False))
    assert analysis["A"].wcrt == 4 * US
    assert analysis["A"].response.terms == {"own": 2 * US, "interference": 0, "blocking": 2 * US}
    assert analysis["B"].wcrt == 3 * US


def varying(tasks):
    """A system in which each task executes for any time from `B` to `C`."""
    system = system_of(tasks, [task["name"] for task in tasks], preemptive=False)
    for task in tasks:
        system = changed(system, task["name"], activities=(ticks(task["C"], task["B"]),))
    return system


def extremes(tasks):
    """The longest and shortest response times: each decision of the core, with each execution time, from everything that is pending."""
    hyperperiod = lcm(*(task["T"] for task in tasks))
    found, seen, left = [[] for _ in tasks], set(), [(0, (0,) * len(tasks))]
    while left:
        now, started = left.pop()
        releases = [task["O"] + number * task["T"] for task, number in zip(tasks, started, strict=True)]
        now = max(now, min(releases))
        chosen = next(index for index, release in enumerate(releases) if release <= now)
        follower = tuple(number + (index == chosen) for index, number in enumerate(started))
        for cost in range(tasks[chosen]["B"], tasks[chosen]["C"] + 1):
            end = now + cost
            found[chosen].append(end - releases[chosen])
            # All tasks have been released once after two hyperperiods; a later state is that of one hyperperiod before.
            rounds = max(0, end // hyperperiod - 2)
            early = tuple(number - rounds * hyperperiod // task["T"] for task, number in zip(tasks, follower, strict=True))
            state = end - rounds * hyperperiod, early
            if state not in seen:
                seen.add(state)
                left.append(state)
    return [(max(times), min(times)) for times in found]


@examples(24)
@given(task_sets(), st.lists(st.integers(0, 3), min_size=4, max_size=4))
def test_of_execution_times_that_vary_each_combination_counts(tasks, less):
    tasks = [{**task, "B": max(1, task["C"] - by)} for task, by in zip(tasks, less, strict=False)]
    analysis = analyze_system(varying(tasks))
    found = [(analysis[task["name"]].wcrt // US, analysis[task["name"]].bcrt // US) for task in tasks]
    assert found == extremes(tasks)
    assert {process.response.claim for process in analysis.processes} == {Claim.EXACT}


def test_a_shorter_job_lets_another_one_go_first():
    # If Short takes 2, Long executes from 2 to 6, then Top, and Mid from 7 to 8. If it takes 3, Mid goes first, and Long from 4 to 8.
    tasks = [
        {"name": "Top", "B": 1, "C": 1, "T": 20, "O": 5},
        {"name": "Mid", "B": 1, "C": 1, "T": 20, "O": 3},
        {"name": "Short", "B": 2, "C": 3, "T": 20, "O": 0},
        {"name": "Long", "B": 4, "C": 4, "T": 20, "O": 0},
    ]
    analysis = analyze_system(varying(tasks))
    assert [analysis[name].wcrt // US for name in ("Top", "Mid", "Short", "Long")] == [4, 5, 3, 8]
    assert analysis["Top"].response.terms == {"own": US, "interference": 0, "blocking": 3 * US}


def test_a_jitter_makes_it_a_bound_that_is_taken_where_it_is_tighter():
    # Nothing is released while B executes from 0 to 3, and A from 10 to 12 or 11 to 13: neither ever waits.
    tasks = [{"name": "A", "C": 2, "T": 20, "O": 10}, {"name": "B", "C": 3, "T": 20, "O": 0}]
    system = system_of(tasks, "AB", preemptive=False)
    late = replace(system.stimuli_by_name["every A"], jitter=Boundaries(lower=0, upper=1 * US))
    stimuli = Stimuli(stimuli=(late, system.stimuli_by_name["every B"]))
    analysis = analyze_system(replace(system, stimuli=stimuli))
    assert (analysis["A"].wcrt // US, analysis["B"].wcrt // US) == (3, 3)
    assert {process.response.claim for process in analysis.processes} == {Claim.BOUND}


def test_only_a_bound_is_claimed_beside_a_schedule_point():
    system = changed(system_of(TASKS, "AB", preemptive=False), "B", activities=(ticks(3), SchedulePoint()))
    analysis = analyze_system(system)
    assert {process.response.claim for process in analysis.processes} == {Claim.BOUND}
    assert ASSUMPTION not in analysis.assumptions


@pytest.mark.parametrize(("limit", "claim"), [(1, Claim.BOUND), (2, Claim.EXACT)])
def test_only_a_bound_is_claimed_if_activations_are_lost(limit, claim):
    # B executes from 0 to 2, Long from 2 to 9; meanwhile B is activated at 4, and again at 8 before that job has begun.
    tasks = [{"name": "Long", "C": 7, "T": 20, "O": 0}, {"name": "B", "C": 2, "T": 4, "O": 0}]
    system = changed(system_of(tasks, ["B", "Long"], preemptive=False), "B", activation_limit=limit)
    assert {process.response.claim for process in analyze_system(system).processes} == {claim}
