"""Offsets, against all vectors of offsets."""

from dataclasses import replace
from itertools import combinations
from math import lcm, prod

import pytest
from design_search import offset_problem, offsets, problem_of
from design_systems import DESIGN, system_of

from amalthea_uros.design.changes.change import parse_sweep
from amalthea_uros.design.optimize.choices import Wishes
from amalthea_uros.design.optimize.offsets import offset_classes, solve_offsets
from amalthea_uros.design.optimize.problem import Conclusion, Goal
from amalthea_uros.design.optimize.search import try_all
from amalthea_uros.design.optimize.space import Choice, DecisionKind, Space
from amalthea_uros.services.optimize import plan_optimization
from amalthea_uros.units import MICROSECOND as US


@pytest.mark.parametrize("case", DESIGN.get("offset_problems", ()), ids=lambda case: case["id"])
def test_the_minimum_over_all_offsets(case):
    problem = offset_problem(case)
    found = solve_offsets(problem)
    assert found.conclusion is Conclusion.OPTIMAL
    value = found.best[0].values[0]
    assert value == case["minimum"] * US
    assert max(each.values[0] for each in found.best) == case["maximum"] * US
    sizes = {designs[0]: len(designs) for designs in offset_classes(problem)}
    assert sum(sizes[each.candidate] for each in found.best if each.values[0] == value) == case["best_vectors"]
    assert found.tried + found.excluded == case["vectors"]
    # Goossens 2003.
    periods = [task["T"] for task in case["tasks"]]
    assert found.tried == prod(periods) // lcm(*periods)


def test_shifts_of_each_other_have_equal_values():
    tasks = [
        {"name": "A", "C": 2, "T": 6, "O": 0},
        {"name": "B", "C": 1, "T": 4, "O": 0},
        {"name": "C", "C": 1, "T": 6, "O": 0},
    ]
    problem = problem_of(system_of(tasks, "BAC"), offsets(tasks), lambda analysis: analysis["C"].wcrt)
    classes = offset_classes(problem)
    assert (len(classes), sum(map(len, classes))) == (6 * 4 * 6 // 12, 6 * 4 * 6)
    for designs in classes:
        values = {each.values for each in problem.evaluate([designs[0], designs[-1]])}
        assert len(values) == 1
        # The present design is first where it is one of them.
        assert all(len(designs[0]) <= len(design) for design in designs)
    assert all(not set(one) & set(other) for one, other in combinations(classes, 2))


def test_what_depends_on_the_start_is_judged_for_each_vector():
    # All have the same distances, but A is sometimes released alone at the start, and is then earlier than ever after.
    tasks = [
        {"name": "A", "C": 1, "T": 3, "O": 2},
        {"name": "B", "C": 2, "T": 6, "O": 0},
        {"name": "C", "C": 1, "T": 3, "O": 0},
    ]
    offers = tuple(parse_sweep(f"{task['name']}.offset=" + ",".join(f"{n}us" for n in range(task["T"]))) for task in tasks)
    problem = plan_optimization(system_of(tasks, "ACB"), Wishes(vary=(), offers=offers), goals=["jitter"]).problem
    assert {len(designs) for designs in offset_classes(problem)} == {1}
    every = try_all(problem, is_complete=True)
    assert solve_offsets(problem).best[0].values == every.best[0].values
    shifted = replace(problem, goals=(Goal(name="load"), Goal(name="changes")), named=frozenset({("A", "response_time")}))
    assert len(offset_classes(shifted)) == 3 * 6 * 3 // 6


def test_jitter_leaves_nothing_to_shift():
    tasks = [{"name": "A", "C": 1, "T": 4, "O": 0}, {"name": "B", "C": 1, "T": 4, "J": 2}]
    problem = problem_of(system_of(tasks), offsets(tasks[:1]))
    assert len(offset_classes(problem)) == 4
    assert solve_offsets(problem).proof == "all 4 vectors of offsets were judged"


def test_other_choices_are_left_to_others():
    tasks = [{"name": "A", "C": 1, "T": 4, "O": 0}]
    period = Choice(object="A", key="period", kind=DecisionKind.PERIOD, options=("4 us", "5 us"))
    space = Space(choices=(*offsets(tasks).choices, period))
    assert solve_offsets(problem_of(system_of(tasks), space)) is None
    assert solve_offsets(problem_of(system_of(tasks), Space())) is None
