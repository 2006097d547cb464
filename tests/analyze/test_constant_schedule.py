"""Non-preemptive tasks with known releases and constant execution times, against a schedule that is played unit by unit."""

from dataclasses import replace
from math import lcm

import pytest
from design_systems import system_of
from effort import examples
from hypothesis import assume, given
from hypothesis import strategies as st

from amalthea_uros.analyze.response_times.constant_schedule import ASSUMPTION
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import Demand, Execute, SchedulePoint
from amalthea_uros.perf.distributions import Boundaries
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import MICROSECOND as US


def played(tasks):
    """The longest response time of each task, the most important one first."""
    cycle, start = lcm(*(task["T"] for task in tasks)), max(task["O"] for task in tasks)
    worst, waiting, running = [0] * len(tasks), [], None
    for now in range(start + 6 * cycle):
        waiting += [(rank, now) for rank, task in enumerate(tasks) if now >= task["O"] and (now - task["O"]) % task["T"] == 0]
        if running is None and waiting:
            rank, release = min(waiting)
            waiting.remove((rank, release))
            running = rank, release, tasks[rank]["C"]
        if running is not None:
            rank, release, left = running
            running = (rank, release, left - 1) if left > 1 else None
            if left == 1:
                worst[rank] = max(worst[rank], now + 1 - release)
    return worst


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


def varying(system):
    task = system.software.tasks[1]
    demand = Execute(demand=Demand(Boundaries(lower=1, upper=3)))
    return with_second(system, replace(task, activities=(demand,)))


def yielding(system):
    task = system.software.tasks[1]
    return with_second(system, replace(task, activities=(*task.activities, SchedulePoint())))


def with_second(system, task):
    return replace(system, software=replace(system.software, tasks=(system.software.tasks[0], task)))


@pytest.mark.parametrize("change", [varying, yielding], ids=lambda change: change.__name__)
def test_only_a_bound_is_claimed_where_the_schedule_can_be_another_one(change):
    analysis = analyze_system(change(system_of(TASKS, "AB", preemptive=False)))
    assert {process.response.claim for process in analysis.processes} == {Claim.BOUND}
    assert ASSUMPTION not in analysis.assumptions


@pytest.mark.parametrize(("limit", "claim"), [(1, Claim.BOUND), (2, Claim.EXACT)])
def test_only_a_bound_is_claimed_if_activations_are_lost(limit, claim):
    # B executes from 0 to 2, Long from 2 to 9; meanwhile B is activated at 4, and again at 8 before that job has begun.
    tasks = [{"name": "Long", "C": 7, "T": 20, "O": 0}, {"name": "B", "C": 2, "T": 4, "O": 0}]
    system = system_of(tasks, ["B", "Long"], preemptive=False)
    changed = with_second(system, replace(system.software.tasks[1], activation_limit=limit))
    assert {process.response.claim for process in analyze_system(changed).processes} == {claim}
