"""Annealing: equal results for equal seeds, whoever judges the designs."""

from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from math import factorial

from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.optimize.annealing import Design, solve_by_annealing
from amalthea_uros.design.optimize.problem import Conclusion, DesignEvaluation, Feasibility, Goal, Problem
from amalthea_uros.design.optimize.space import Choice, DecisionKind, PriorityOrder, Space
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.settings import Settings

NAMES = tuple("ABCDEFGH")
SPACE = Space(
    choices=tuple(Choice(object=name, key="period", kind=DecisionKind.PERIOD, options=("0", "1", "2", "3")) for name in NAMES),
    orders=(PriorityOrder(scheduler="core", tasks=NAMES, numbers=tuple(range(8, 0, -1))),),
)


def judge(design):
    """Each task has a number that fits and a place that fits: each unit of distance from them is late by 1 ms."""
    numbers = {change.target: int(change.value) for change in design}
    late = 0
    for place, name in enumerate(NAMES):
        late += abs(numbers.get(f"{name}.period", 0) - (place + 1) % 4)
        late += abs(numbers.get(f"{name}.priority", 8 - place) - (place + 1))
    feasible = Feasibility.YES if late <= 8 else Feasibility.NO
    violations = {} if late <= 8 else {"all": late * 10**9}
    return DesignEvaluation(candidate=design, feasible=feasible, violations=violations, values=(Fraction(late),))


def problem(seed=1, evaluate=lambda designs: list(map(judge, designs)), space=SPACE):
    present = Configuration(System(), Settings())
    return Problem(
        present=present, space=space, goals=(Goal(name="late"),), configure=lambda _: present, evaluate=evaluate, seed=seed
    )


def test_a_design_that_meets_all_limits_is_found_among_many():
    # 40,320 orders with 65,536 options each; the present design is late by 44.
    assert SPACE.size == 4**8 * factorial(8)
    assert judge(()).violations == {"all": 44 * 10**9}
    found = solve_by_annealing(problem(), designs=3000)
    assert (found.conclusion, found.tried, found.ended) == (Conclusion.BEST_FOUND, 3000, "3000 designs were judged")
    assert found.best[0].values[0] <= 4
    assert found.proof == ""


def test_results_do_not_depend_on_who_judges():
    def on_several(designs):
        with ThreadPoolExecutor(3) as pool:
            return list(pool.map(judge, designs))

    def tried(seed, evaluate):
        """All designs, in the order in which they were judged."""
        found = []
        solve_by_annealing(problem(seed, lambda designs: found.extend(designs) or evaluate(designs)), designs=500)
        return found

    one = tried(1, lambda designs: list(map(judge, designs)))
    assert len(set(one)) == len(one) == 500
    assert tried(1, on_several) == one
    assert tried(2, on_several) != one


def test_a_design_is_written_as_the_values_that_differ():
    present = Design.present(SPACE)
    assert present.candidate(SPACE) == ()
    changed = Design((0, 2, *present.options[2:]), (("B", "A", *NAMES[2:]),))
    assert [str(change) for change in changed.candidate(SPACE)] == ["A.priority=7", "B.period=2", "B.priority=8"]
