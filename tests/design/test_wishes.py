"""What a user says about the space of designs holds: nothing kept changes, and each value is decided once."""

from dataclasses import replace
from fractions import Fraction

import pytest
from design_systems import system_of
from hand_made_systems import of_parts, ticks

from amalthea_uros.design.changes.change import parse_sweep
from amalthea_uros.design.optimize.choices import Vary, Wishes
from amalthea_uros.design.optimize.mapping import solve_mapping
from amalthea_uros.design.optimize.problem import Conclusion
from amalthea_uros.design.optimize.search import try_all
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.os import Policy
from amalthea_uros.perf.software import Task
from amalthea_uros.perf.stimuli import Periodic
from amalthea_uros.services.optimize import optimize, plan_optimization
from amalthea_uros.units import MICROSECOND

TASKS = [{"name": "A", "C": 5, "T": 10, "D": 10}, {"name": "B", "C": 2, "T": 10, "D": 10}]


def space_of(*, vary=("priorities",), offers=(), keep=()):
    wishes = Wishes(vary=tuple(map(Vary, vary)), offers=tuple(map(parse_sweep, offers)), keep=tuple(keep))
    return plan_optimization(system_of(TASKS), wishes).problem.space


def test_offered_priorities_replace_an_order_that_would_decide_them_again():
    space = space_of(offers=["A.priority=1,3"])
    assert [choice.target for choice in space.choices] == ["A.priority"]
    # B alone has no order.
    assert (space.orders, space.size) == ((), 2)


def test_the_order_of_a_kept_scheduler_stays():
    assert space_of().size == 2
    assert space_of(keep=["core"]).size == 1


@pytest.mark.parametrize(
    ("wishes", "message"),
    [
        ({"keep": ["A.perio"]}, "the task 'A' has no 'perio'; did you mean 'period'?"),
        ({"keep": ["C.period"]}, "unknown object to keep 'C'"),
        ({"offers": ["A.offset=1us", "A.offset=2us"]}, "'A.offset' is on offer twice; offer all its values together"),
    ],
)
def test_what_would_have_no_effect_is_refused(wishes, message):
    with pytest.raises(InvalidArgumentError) as raised:
        space_of(**wishes)
    assert message in str(raised.value)


@pytest.mark.parametrize("limit", ["one.load<=30%", "two.load<=30%", "one.load<=50%"])
@pytest.mark.parametrize("goals", [("load",), ("load", "one.load"), ("two.load", "load"), ("changes",)])
def test_like_cores_cannot_take_the_place_of_one_that_a_limit_or_goal_names(limit, goals):
    wishes = Wishes(vary=(), offers=(parse_sweep("A.core=one,two"), parse_sweep("B.core=one,two")))
    plan = plan_optimization(system_of(TASKS, cores=("one", "two")), wishes, limits=[limit], goals=goals)
    found, every = solve_mapping(plan.problem), try_all(plan.problem, is_complete=True)
    # A needs 50 % of a core, B 20 %: one of both has to be elsewhere, so that there is a solution for each limit.
    assert every.conclusion is Conclusion.OPTIMAL
    if found is not None:
        assert found.conclusion is Conclusion.OPTIMAL
        assert found.best[0].values == every.best[0].values


def test_a_core_that_no_moved_task_uses_can_have_the_largest_load():
    tasks = [
        {"name": "A", "C": 1, "T": 8, "D": 8},
        {"name": "B", "C": 4, "T": 8, "D": 8},
        {"name": "C", "C": 1, "T": 8, "D": 8},
    ]
    cores, core_of = ("one", "two", "three"), {"A": "three", "B": "three", "C": "two"}
    system = system_of(tasks, cores=cores, core_of=core_of)
    wishes = Wishes(vary=(), offers=(parse_sweep("A.core=three,two"), parse_sweep("C.core=two,one")))
    found = solve_mapping(plan_optimization(system, wishes, goals=["load"]).problem)
    # B alone needs half of its core, so that it is enough to move A, although A and C could have a core each.
    assert (found.conclusion, [change.target for change in found.best[0].candidate]) == (Conclusion.OPTIMAL, ["A.core"])
    assert found.best[0].values[0] == Fraction(1, 2)


def test_the_order_of_tasks_in_a_file_does_not_count():
    tasks = [{"name": name, "C": 1, "T": 20, "D": 20, "O": 0} for name in "ABCD"]

    def proposed(system):
        found = optimize(system, goals=["jitter"], vary=["offsets"], designs=15, seed=3)
        return [proposal.changes for proposal in found.proposals]

    system = system_of(tasks)
    reverse = replace(
        system,
        software=replace(system.software, tasks=system.software.tasks[::-1]),
        mapping=replace(system.mapping, tasks=system.mapping.tasks[::-1]),
    )
    assert proposed(system) == proposed(reverse) != []


def test_tasks_that_nothing_dispatches_are_given_cores():
    # 60 % of a core each: only on different ones both meet their deadlines.
    tasks = [Task(name=name, stimuli=("tick",), activities=(ticks(60),)) for name in "AB"]
    stimulus = Periodic(name="tick", period=100 * MICROSECOND)
    system = of_parts(tasks, [], [stimulus], cores=("c0", "c1"), policy=Policy.FIXED_PRIORITY_PREEMPTIVE)
    found = optimize(system, vary=["cores"])
    assert found.search.conclusion is Conclusion.OPTIMAL
    assert {tuple(map(str, each.changes)) for each in found.proposals} == {
        ("A.core=c0", "B.core=c1"),
        ("A.core=c1", "B.core=c0"),
    }


def test_values_on_offer_are_all_new_where_the_present_design_has_none():
    # Without a stated deadline, there are two designs with one and the present one.
    system = system_of([{"name": "A", "C": 5, "T": 10, "D": 10}, {"name": "B", "C": 5, "T": 10, "D": 10}])
    allocations = tuple(replace(each, deadline=None) for each in system.mapping.tasks)
    wishes = Wishes(vary=(), offers=(parse_sweep("A.deadline=5us,6us"),))
    problem = plan_optimization(replace(system, mapping=replace(system.mapping, tasks=allocations)), wishes).problem
    assert [choice.options for choice in problem.space.choices] == [("not set", "5us", "6us")]
