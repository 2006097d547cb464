"""Non-preemptive tasks with known releases and constant execution times, against a schedule that is played unit by unit."""

from math import lcm

import pytest
from design_systems import system_of
from effort import examples
from hand_made_systems import changed, ticks
from hypothesis import assume, given
from hypothesis import strategies as st
from unit_player import UnitTask, longest_responses

from amalthea_uros.analyze.response_times.constant_schedule import ASSUMPTION
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import SchedulePoint
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


@pytest.mark.parametrize(
    "body", [(ticks(3, 1),), (ticks(3), SchedulePoint())], ids=["a varying execution time", "a schedule point"]
)
def test_only_a_bound_is_claimed_where_the_schedule_can_be_another_one(body):
    analysis = analyze_system(changed(system_of(TASKS, "AB", preemptive=False), "B", activities=body))
    assert {process.response.claim for process in analysis.processes} == {Claim.BOUND}
    assert ASSUMPTION not in analysis.assumptions


@pytest.mark.parametrize(("limit", "claim"), [(1, Claim.BOUND), (2, Claim.EXACT)])
def test_only_a_bound_is_claimed_if_activations_are_lost(limit, claim):
    # B executes from 0 to 2, Long from 2 to 9; meanwhile B is activated at 4, and again at 8 before that job has begun.
    tasks = [{"name": "Long", "C": 7, "T": 20, "O": 0}, {"name": "B", "C": 2, "T": 4, "O": 0}]
    system = changed(system_of(tasks, ["B", "Long"], preemptive=False), "B", activation_limit=limit)
    assert {process.response.claim for process in analyze_system(system).processes} == {claim}
