"""Mappings of tasks to cores, against all mappings."""

from dataclasses import replace
from fractions import Fraction
from importlib.util import find_spec

import pytest
from design_search import cores_of, mapping_problem
from design_systems import DESIGN

from amalthea_uros import optimize
from amalthea_uros.design.optimize import mapping
from amalthea_uros.design.optimize.integer_program import solve_program
from amalthea_uros.design.optimize.mapping import BranchAndBound, solve_mapping
from amalthea_uros.design.optimize.partition import Partition
from amalthea_uros.design.optimize.problem import Conclusion, Feasibility, Problem
from amalthea_uros.design.optimize.space import Choice, DecisionKind, Space
from amalthea_uros.perf.os import Policy

CASES = DESIGN.get("mapping_problems", ())
needs_ortools = pytest.mark.skipif(not find_spec("ortools"), reason="OR-tools is not installed")


def check_result(found, case):
    if case["feasible"]:
        assert found.conclusion is Conclusion.OPTIMAL
        assert found.best[0].values == (Fraction(case["min_max_load"]),)
    else:
        assert (found.conclusion, found.best) == (Conclusion.NONE, ())
    assert "sets of tasks of a core were analysed" in found.proof


@pytest.mark.parametrize("case", CASES, ids=lambda case: case["id"])
def test_the_smallest_largest_load(case):
    problem = mapping_problem(case["tasks"], cores_of(case))
    check_result(solve_mapping(problem), case)
    assert len(BranchAndBound(Partition.of(problem), "load").best()) == case.get("optimal_count", 0)


@needs_ortools
@pytest.mark.parametrize("case", CASES, ids=lambda case: case["id"])
def test_the_integer_program_agrees(case, monkeypatch):
    monkeypatch.setattr(mapping, "MAX_ASSIGNMENTS", 1)
    found = solve_mapping(mapping_problem(case["tasks"], cores_of(case)))
    check_result(found, case)
    assert "CP-SAT of OR-tools" in found.proof


@pytest.mark.parametrize(
    "case", [case for case in CASES if case["id"] in ("mapping-07", "mapping-11")], ids=lambda case: case["id"]
)
def test_the_command_varies_the_cores_of_tasks(case):
    # 2,187 mappings are more than are tried one by one; of the 128 others, some only miss a bound of the analysis.
    system = mapping_problem(case["tasks"], cores_of(case)).present.system
    found = optimize(system, vary=["cores"], goals=["load"])
    assert found.search.conclusion is (Conclusion.OPTIMAL if case["feasible"] else Conclusion.NONE)
    if case["feasible"]:
        assert found[0].evaluation.values[0] == Fraction(case["min_max_load"])
        assert {change.key for change in found[0].changes} == {"core"}


TASKS = [
    {"name": "A", "C": 6, "T": 10, "D": 10},
    {"name": "B", "C": 5, "T": 10, "D": 10},
    {"name": "C", "C": 3, "T": 10, "D": 10},
]


def test_the_fewest_changes():
    # All three need 140 % of a core; without A, B and C fit on the first one; without B or C alone, only A and C do.
    found = solve_mapping(mapping_problem(TASKS, ["one", "two"], "changes"))
    assert found.conclusion is Conclusion.OPTIMAL
    assert [[str(change) for change in each.candidate] for each in found.best] == [["A.core=two"], ["B.core=two"]]


def test_the_load_counts_what_stays():
    # Fixed needs 30 % of the first core. A with it makes 90 %, and so does B with it, because A and C need 90 % of the other one.
    tasks = [*TASKS, {"name": "Fixed", "C": 3, "T": 10, "D": 10}]
    problem = mapping_problem(tasks, ["one", "two"])
    space = Space(choices=tuple(choice for choice in problem.space.choices if choice.object != "Fixed"))
    found = solve_mapping(replace(problem, space=space))
    assert (found.conclusion, found.best[0].values, len(found.best)) == (Conclusion.OPTIMAL, (Fraction(9, 10),), 2)


def test_no_loads_are_rounded():
    # 0.2 + 0.4 + 0.3 + 0.1 is more than 1 in floats, but fits.
    tasks = [{"name": name, "C": cost, "T": 10, "D": 10} for name, cost in zip("ABCD", (2, 4, 3, 1), strict=True)]
    choices = tuple(Choice(object=name, key="core", kind=DecisionKind.CORE, options=("one", "two")) for name in "AD")
    blocked = {"name": "E", "C": 10, "T": 10, "D": 10}
    problem = mapping_problem([*tasks, blocked], ["one", "two"], core_of={"E": "two"})
    found = solve_mapping(replace(problem, space=Space(choices=choices)))
    assert (found.conclusion, found.best[0].candidate, found.best[0].values) == (Conclusion.OPTIMAL, (), (1,))


def refusing(problem: Problem, allowed) -> Problem:
    """The problem with a limit that only some designs meet, as one of a chain would be."""

    def evaluate(designs):
        return [each if allowed(each) else replace(each, feasible=Feasibility.NO) for each in problem.evaluate(designs)]

    return replace(problem, evaluate=evaluate)


def test_another_mapping_is_taken_where_the_analysis_refuses_the_best_one():
    problem = mapping_problem(TASKS, ["one", "two"])
    assert solve_mapping(problem).best[0].values == (Fraction(8, 10),)
    found = solve_mapping(refusing(problem, lambda each: each.values[0] > Fraction(8, 10)))
    assert (found.conclusion, found.best[0].values) == (Conclusion.OPTIMAL, (Fraction(9, 10),))
    nothing = solve_mapping(refusing(problem, lambda each: False))
    assert (nothing.conclusion, nothing.best) == (Conclusion.NONE, ())


@needs_ortools
def test_equal_runs_of_the_integer_program_are_equal():
    problem = mapping_problem([task | {"name": f"{task['name']}{n}"} for task in TASKS for n in range(3)], list("wxyz"))
    results = [solve_program(Partition.of(problem)) for _ in range(2)]
    assert results[0] == results[1]
    # Nine tasks of 4.2 cores in total do not fit.
    assert (results[0].assignment, results[0].is_proved) == (None, True)


def test_tasks_that_share_time_in_slices_are_left_to_others():
    # Without one of them, the slices of the others come at other times, which can be later ones.
    problem = mapping_problem(TASKS, ["one", "two"])
    system = problem.present.system
    mapping = replace(system.mapping, tasks=tuple(replace(each, priority=1) for each in system.mapping.tasks))
    (os,) = system.os.systems
    schedulers = tuple(replace(each, policy=Policy.PRIORITY_BASED_ROUND_ROBIN) for each in os.schedulers)
    slices = replace(system, mapping=mapping, os=replace(system.os, systems=(replace(os, schedulers=schedulers),)))
    assert solve_mapping(replace(problem, present=problem.present._replace(system=slices))) is None


def test_tasks_that_block_each_other_are_left_to_others():
    tasks = [task | {"locks": {"R": 1}} for task in TASKS]
    assert solve_mapping(mapping_problem(tasks, ["one", "two"])) is None
    assert solve_mapping(mapping_problem(TASKS, ["one", "two"], preemptive=False)) is None
    assert solve_mapping(mapping_problem(TASKS, ["one", "two"], "jitter")) is None
