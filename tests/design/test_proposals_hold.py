"""Proposals hold in the simulation of their designs, and the same seed gives the same proposals."""

from dataclasses import replace

import pytest
from design_systems import system_of
from effort import examples
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros import optimize, simulate
from amalthea_uros._internal.plural import counted
from amalthea_uros.design.optimize import judged
from amalthea_uros.design.optimize.judged import Effort
from amalthea_uros.design.optimize.problem import Conclusion
from amalthea_uros.design.optimize.search import search
from amalthea_uros.design.optimize.space import (
    Choice,
    DecisionKind,
    PriorityOrder,
    Space,
    count_with,
    designs_with,
    most_changes,
)
from amalthea_uros.services.optimize import plan_optimization
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import Duration


@st.composite
def task_sets(draw):
    tasks = []
    for name in "ABC":
        period = draw(st.sampled_from((4, 5, 8, 10, 20)))
        execution = draw(st.integers(1, max(1, period // 3)))
        deadline = draw(st.integers(max(execution, period // 2), period))
        tasks.append({"name": name, "C": execution, "T": period, "D": deadline, "O": draw(st.integers(0, 2))})
    return system_of(tasks)


@examples(9)
@given(system=task_sets())
def test_no_deadline_is_missed_in_the_simulation_of_a_proposal(system):
    found = optimize(system, proposals=2)
    for proposal in found.proposals:
        assert proposal.analysis.summary.schedulable == "yes"
        run = simulate(proposal.configuration.system, Duration(MS))
        for process in proposal.analysis.processes:
            observed = run.processes[process.name].metrics["response_time"].max
            assert observed <= process.wcrt <= process.deadline
    if found.search.conclusion is Conclusion.NONE:
        assert not found.search.best
    again = optimize(system, proposals=2)
    assert [each.changes for each in again.proposals] == [each.changes for each in found.proposals]


def test_designs_are_counted_as_they_are_listed():
    space = Space(
        choices=(
            Choice(object="A", key="period", kind=DecisionKind.PERIOD, options=("1ms", "2ms", "4ms")),
            Choice(object="B", key="offset", kind=DecisionKind.OFFSET, options=("0s", "1ms")),
        ),
        orders=(PriorityOrder(scheduler="S", tasks=("A", "B", "C"), numbers=(3, 2, 1)),),
    )
    listed = [list(designs_with(space, changes)) for changes in range(most_changes(space) + 1)]
    assert [len(each) for each in listed] == [count_with(space, changes) for changes in range(len(listed))]
    every = [design for level in listed for design in level]
    # 3 periods, 2 offsets, 3! orders
    assert len(set(every)) == len(every) == space.size == 36
    assert all(len(design) == changes for changes, level in enumerate(listed) for design in level)


def test_an_interrupt_or_the_time_limit_ends_a_search_with_what_was_found():
    tasks = [{"name": name, "C": 1, "T": 8, "D": 8} for name in "ABCDE"]
    plan = plan_optimization(system_of(tasks), goals=["load"])
    calls = []

    def interrupted(candidates):
        calls.append(candidates)
        if len(calls) == 3:
            raise KeyboardInterrupt
        return plan.evaluator(candidates)

    found = search(replace(plan.problem, evaluate=interrupted), Effort(is_complete=True))
    assert found.ended == "interrupted"
    assert found.conclusion is Conclusion.BEST_FOUND
    assert found.tried == len(calls[0]) + len(calls[1])
    late = search(plan.problem, Effort(ended=lambda: "the time limit was reached"))
    assert (late.conclusion, late.tried, late.ended) == (Conclusion.NOT_FOUND, 0, "the time limit was reached")


@pytest.mark.parametrize("designs", [1, 2])
def test_the_work_of_the_analyses_ends_a_search_with_what_was_found(designs, monkeypatch):
    """What counts is the work of all designs; the analysis with which it is reached is completed."""
    tasks = [{"name": name, "C": 1, "T": 8, "D": 8} for name in "ABCDE"]
    plan = plan_optimization(system_of(tasks), goals=["load"])
    work = plan.before.work
    assert work >= 5 * 100
    monkeypatch.setattr(judged, "WORK_PER_DESIGN", designs * work // 500)
    found = search(plan.problem, Effort(designs=500, is_complete=True))
    assert found.tried == designs
    assert found.conclusion is Conclusion.BEST_FOUND
    assert found.ended == f"judging {counted(designs, 'design')} took as much work as 500 designs may take"


def test_a_search_that_has_judged_everything_is_complete_whatever_the_work(monkeypatch):
    tasks = [{"name": name, "C": 1, "T": 8, "D": 8} for name in "AB"]
    plan = plan_optimization(system_of(tasks), goals=["load"])
    whole = search(plan.problem, Effort(is_complete=True))
    assert (whole.conclusion, whole.ended) == (Conclusion.OPTIMAL, "")
    monkeypatch.setattr(judged, "WORK_PER_DESIGN", plan.before.work)
    found = search(plan.problem, Effort(designs=whole.tried, is_complete=True))
    assert (found.conclusion, found.ended, found.tried) == (Conclusion.OPTIMAL, "", whole.tried)
