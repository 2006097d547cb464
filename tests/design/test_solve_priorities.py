"""Orders of priorities, against all orders."""

from collections.abc import Iterator, Sequence
from itertools import permutations
from random import Random

import pytest
from design_search import order_problem, order_space, orders_of, problem_of
from design_systems import DESIGN, system_of
from effort import IS_THOROUGH

from amalthea_uros.analyze.priorities.assignment import ProposalOutcome, propose_priorities
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.optimize.priorities import solve_priorities
from amalthea_uros.design.optimize.problem import Conclusion
from amalthea_uros.design.optimize.space import Choice, DecisionKind, PriorityOrder, Space
from amalthea_uros.units import MICROSECOND as US


def worst_response(task: dict, above: Sequence[dict], below: Sequence[dict]) -> int | None:
    """From the nominal arrival, by the recurrence of Audsley and others 1993; None beyond the period."""
    used = {lock for each in (task, *above) for lock in each["locks"]}
    blocking = max((each["locks"][lock] for each in below for lock in used if lock in each["locks"]), default=0)
    response = -1
    found = task["C"] + blocking
    while found != response:
        response = found
        found = blocking + task["C"] + sum(-(-(response + each["J"]) // each["T"]) * each["C"] for each in above)
        if found + task["J"] > task["T"]:
            return None
    return response + task["J"]


def all_orders(tasks: Sequence[dict]) -> set[tuple[str, ...]]:
    """The orders in which all tasks meet their deadlines, the most important task first."""

    def meets(order: Sequence[dict]) -> bool:
        times = (worst_response(task, order[:place], order[place + 1 :]) for place, task in enumerate(order))
        return all(time is not None and time <= task["D"] for time, task in zip(times, order, strict=True))

    return {tuple(task["name"] for task in order) for order in permutations(tasks) if meets(order)}


def random_sets(count: int) -> Iterator[list[dict]]:
    """Systems with constrained deadlines, jitter and locks in which rate-monotonic priorities fail."""
    random = Random(1)
    while count:
        tasks = []
        for name in "ABCD"[: random.randint(3, 4)]:
            period, cost = random.choice([6, 8, 10, 12, 15, 20, 24]), random.randint(1, 4)
            deadline = random.randint(min(period, cost + 2), period)
            jitter = random.choice([0, 0, random.randint(0, deadline // 2)])
            locks = {lock: random.randint(1, cost) for lock in "RS" if random.random() < 0.2}
            tasks.append({"name": name, "C": cost, "T": period, "D": deadline, "J": jitter, "locks": locks})
        monotonic = tuple(task["name"] for task in sorted(tasks, key=lambda task: task["T"]))
        if sum(task["C"] / task["T"] for task in tasks) <= 1 and monotonic not in all_orders(tasks):
            count -= 1
            yield tasks


@pytest.mark.parametrize("case", DESIGN.get("priority_exists", ()), ids=lambda case: case["id"])
def test_exactly_the_orders_that_exist_are_found(case):
    problem = order_problem(case["tasks"], preemptive="non-preemptive" not in case["scheduling"])
    found = solve_priorities(problem)
    assert orders_of(problem, found) == set(map(tuple, case["all_feasible_orders"]))
    # With locks, the bound of what is not found does not always prove that a deadline is missed.
    assert found.conclusion is Conclusion.OPTIMAL or (
        case["kind"] == "blocking_jitter" and found.conclusion is Conclusion.BEST_FOUND
    )
    if found.proof:
        assert found.tried + found.excluded == case["orders"]
    assert found.best[0].changes == min(each.changes for each in found.best)


@pytest.mark.parametrize("case", DESIGN.get("priority_none", ()), ids=lambda case: case["id"])
def test_none_is_said_with_the_tasks_that_miss_their_deadlines(case):
    problem = order_problem(case["tasks"], preemptive="non-preemptive" not in case["scheduling"])
    found = solve_priorities(problem)
    assert (found.conclusion, found.best, found.excluded) == (Conclusion.NONE, (), case["orders"])
    assert "misses its deadline: '" in found.proof


@pytest.mark.parametrize("case", DESIGN.get("audsley_fails", ()), ids=lambda case: case["id"])
def test_all_orders_are_tried_where_the_algorithm_of_audsley_fails(case):
    problem = order_problem(case["tasks"], preemptive=False)
    found = solve_priorities(problem)
    assert orders_of(problem, found) == set(map(tuple, case["all_feasible_orders"]))
    assert (found.conclusion, found.tried) == (Conclusion.OPTIMAL, case["orders"])
    assert found.proof == f"all {case['orders']} orders were judged"
    (proposal,) = propose_priorities(analyze_system(problem.present.system))
    assert tuple(sorted(proposal.priorities, key=lambda name: -proposal.priorities[name])) in orders_of(problem, found)


# Random systems, with a brute force of their own


def test_an_order_is_proposed_if_and_only_if_one_of_all_orders_meets_all_deadlines():
    for tasks in random_sets(1000 if IS_THOROUGH else 20):
        (proposal,) = propose_priorities(analyze_system(system_of(tasks)))
        existing = all_orders(tasks)
        if existing:
            assert tuple(sorted(proposal.priorities, key=lambda name: -proposal.priorities[name])) in existing, tasks
        else:
            assert proposal.outcome in (ProposalOutcome.NONE, ProposalOutcome.NOT_FOUND), tasks


# What is excluded, and what is not


TASKS = [
    {"name": "A", "C": 2, "T": 10, "D": 9},
    {"name": "B", "C": 3, "T": 12, "D": 8},
    {"name": "C", "C": 2, "T": 15, "D": 15},
]


def test_the_order_with_the_smallest_value_is_proved():
    # C below the others has to wait for both: 2 + 3 + 2 = 7. In the middle it waits for one, on top for none: 2; then B ends at
    # 2 + 3 + 2 = 7 or 5, and A at 7 or 4, so that all orders meet all deadlines.
    names = [task["name"] for task in TASKS]
    problem = problem_of(system_of(TASKS, names), Space(orders=(order_space(names),)), lambda analysis: analysis["C"].wcrt)
    found = solve_priorities(problem)
    assert (found.conclusion, found.tried, len(found.best)) == (Conclusion.OPTIMAL, 6, 6)
    assert found.best[0].values == (2 * US,)
    # C on top; of both orders of the others, the one in which A and B have changed places as well has fewer changed values.
    assert found.best[0].changes == 2


def test_more_load_than_the_core_has():
    tasks = [task | {"C": 6} for task in TASKS]
    found = solve_priorities(order_problem(tasks))
    assert (found.conclusion, found.tried) == (Conclusion.NONE, 0)
    assert found.proof == "on 'core', with any priorities, the tasks need 150.0 % of the core"


def test_a_limited_search_claims_nothing_of_the_rest():
    found = solve_priorities(order_problem(TASKS), designs=2)
    assert (found.conclusion, found.proof, found.excluded) == (Conclusion.BEST_FOUND, "", 0)
    assert found.ended == "3 designs were judged"


def test_two_cores_are_searched_together():
    core_of = {"A": "one", "B": "one", "C": "two", "D": "two"}
    tasks = [*TASKS, {"name": "D", "C": 1, "T": 4, "D": 1}]
    orders = [("one", "BA", (4, 3)), ("two", "CD", (2, 1))]
    space = Space(orders=tuple(PriorityOrder(scheduler=core, tasks=tuple(names), numbers=n) for core, names, n in orders))
    system = system_of(tasks, "BACD", cores=("one", "two"), core_of=core_of)
    found = solve_priorities(problem_of(system, space))
    # D has to be above C; A and B fit in both orders.
    assert found.conclusion is Conclusion.OPTIMAL
    assert {frozenset(change.object for change in each.candidate) for each in found.best} == {
        frozenset("CD"),
        frozenset("ABCD"),
    }


def test_other_choices_are_left_to_others():
    problem = order_problem(TASKS)
    choice = Choice(object="A", key="offset", kind=DecisionKind.OFFSET, options=("0 us", "1 us"))
    space = Space(choices=(choice,), orders=problem.space.orders)
    assert solve_priorities(problem_of(problem.present.system, space)) is None
    assert solve_priorities(problem_of(problem.present.system, Space(choices=(choice,)))) is None
