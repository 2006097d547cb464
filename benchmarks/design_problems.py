"""How the solvers of design problems do: small problems with known answers, random systems, and a model of the size of a challenge.

python benchmarks/design_problems.py --random 300 --model WATERS_2017.amxmi
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from random import Random
from typing import Any

TESTS = Path(__file__).parents[1] / "tests"
sys.path[:0] = [str(TESTS), str(TESTS / "design")]

from design_search import cores_of, mapping_problem, offset_problem, order_problem, orders_of, problem_of  # noqa: E402
from design_systems import DESIGN, system_of  # noqa: E402
from random_orders import all_orders, random_sets  # noqa: E402
from thesis_designs import changes_of, choose_periods  # noqa: E402

from amalthea_uros import extract, load  # noqa: E402
from amalthea_uros.analyze.priorities.assignment import ProposalOutcome, propose_priorities  # noqa: E402
from amalthea_uros.analyze.priorities.orders import with_priorities  # noqa: E402
from amalthea_uros.analyze.results.analysis import Analysis  # noqa: E402
from amalthea_uros.analyze.system import analyze_system  # noqa: E402
from amalthea_uros.design.optimize.annealing import solve_by_annealing  # noqa: E402
from amalthea_uros.design.optimize.mapping import solve_mapping  # noqa: E402
from amalthea_uros.design.optimize.offsets import solve_offsets  # noqa: E402
from amalthea_uros.design.optimize.priorities import solve_priorities  # noqa: E402
from amalthea_uros.design.optimize.problem import Conclusion, Goal, SearchResult  # noqa: E402
from amalthea_uros.design.optimize.space import Choice, DecisionKind, Space  # noqa: E402
from amalthea_uros.services.optimize import plan_optimization  # noqa: E402
from amalthea_uros.timing.basics.settings import Settings  # noqa: E402
from amalthea_uros.units import MICROSECOND as US  # noqa: E402

#: The clock of the cores with which the model of the challenge of 2017 is schedulable.
FREQUENCY = Fraction(300 * 10**6)


def orders(case: dict[str, Any]) -> str:
    problem = order_problem(case["tasks"], preemptive="non-preemptive" not in case["scheduling"])
    found = solve_priorities(problem)
    assert found is not None
    known = set(map(tuple, case.get("all_feasible_orders", ())))
    if not orders_of(problem, found) <= known:
        return "WRONG"
    return answer(found, bool(known), orders_of(problem, found) == known)


def offsets(case: dict[str, Any]) -> str:
    found = solve_offsets(offset_problem(case))
    assert found is not None
    return answer(found, True, found.best[0].values[0] == case["minimum"] * US)


def mappings(case: dict[str, Any]) -> str:
    found = solve_mapping(mapping_problem(case["tasks"], cores_of(case)))
    assert found is not None
    return answer(found, case["feasible"], not found.best or found.best[0].values[0] == Fraction(case["min_max_load"]))


def periods(case: dict[str, Any]) -> str:
    found = choose_periods(case).search
    is_right = len(found.best) == len(case["feasible"])
    is_best = not found.best or found.best[0].values[0] == Fraction(case["least_load"])
    return answer(found, bool(case["feasible"]), is_right and is_best)


def thesis(case: dict[str, Any]) -> str:
    """Whether each single change of the thesis's application has the latency that its schedule has."""
    plan = plan_optimization(TESTS.parent / "samples" / "bodas-test-advanced.yaml", may_be_later=True)
    figures = plan.evaluator.scale.figures
    for each in case["rows"]:
        analysis = analyze_system(*plan.evaluator.designs.configure(changes_of(each)))
        found = figures.range(analysis, "factor-to-output", "max_reduced_reaction_time")
        if not found.is_exact or found.upper != each["worst"] * US:
            return "WRONG"
    return "found"


def answer(found: SearchResult, exists: bool, is_right: bool) -> str:
    """What is known in the end; `open` if a design exists and none was found, or the other way round without a proof."""
    if found.conclusion is Conclusion.NONE:
        return "refuted" if not exists else "WRONG"
    if not found.best:
        return "open"
    return ("optimal" if found.conclusion is Conclusion.OPTIMAL else "found") if is_right else "WRONG"


GROUPS: dict[str, Callable[[dict[str, Any]], str]] = {
    "priority_exists": orders,
    "priority_none": orders,
    "audsley_fails": orders,
    "offset_problems": offsets,
    "mapping_problems": mappings,
    "period_problems": periods,
    "thesis": thesis,
}


def random_orders(count: int) -> Iterator[str]:
    """The answer for each of some random systems in which rate-monotonic priorities fail."""
    for tasks in random_sets(count):
        existing = all_orders(tasks)
        (proposal,) = propose_priorities(analyze_system(system_of(tasks)))
        if proposal.priorities is not None:
            numbers = proposal.priorities
            yield "found" if tuple(sorted(numbers, key=lambda name: -numbers[name])) in existing else "WRONG"
        elif proposal.outcome is ProposalOutcome.NONE:
            yield "WRONG" if existing else "refuted"
        else:
            yield "MISSED" if existing else "open"


def challenge(path: Path) -> None:
    """Priorities that were shuffled, and the mapping of some tasks, of a large model."""
    system = extract(load(path)).system
    settings = Settings(frequencies=dict.fromkeys(system.cores, FREQUENCY))
    tasks = [each.task for each in system.mapping.tasks]
    numbers = [each.priority for each in system.mapping.tasks]
    shuffled = Random(1).sample(numbers, len(numbers))
    changed = with_priorities(
        system, {task: number for task, number in zip(tasks, shuffled, strict=True) if number is not None}
    )
    before = analyze_system(changed, settings)
    started = time.process_time()
    proposals = propose_priorities(before)
    outcomes = ", ".join(f"{each.core} {each.outcome}" for each in proposals)
    print(f"priorities shuffled, schedulable: {before.summary.schedulable}; {outcomes}: {time.process_time() - started:.1f} s")
    moved = ("Task_10ms", "Task_1ms", "Task_5ms")
    options = [each.scheduler for each in system.mapping.tasks]
    choices = tuple(
        Choice(object=task, key="scheduler", kind=DecisionKind.CORE, options=(now, *sorted(set(options) - {now})))
        for task, now in zip(tasks, options, strict=True)
        if task in moved
    )
    problem = problem_of(
        system, Space(choices=choices), lambda analysis: max(core.worst or 9 for core in analysis.processors), settings
    )
    started = time.process_time()
    found = solve_by_annealing(replace(problem, goals=(Goal(name="load"),)), designs=100)
    value = float(found.best[0].values[0] or 0) if found.best else None
    first = problem.evaluate([()])[0].values[0]
    print(
        f"mapping of {', '.join(moved)}: largest load {float(first or 0):.3f} before, {value} after; {found.conclusion}, "
        f"{found.tried} of {problem.space.size} designs: {time.process_time() - started:.1f} s"
    )


def largest_load(analysis: Analysis) -> Fraction | None:
    loads = [core.worst for core in analysis.processors]
    return None if None in loads else max(load for load in loads if load is not None)


def row(name: str, answers: Sequence[str], took: float) -> str:
    counts = Counter(answers)
    cells = [str(counts.get(each, 0)) for each in COLUMNS]
    return f"{name:18}{len(answers):>7}" + "".join(f"{cell:>9}" for cell in cells) + f"{took:>8.2f} s"


COLUMNS = ("optimal", "found", "refuted", "open", "MISSED", "WRONG")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--random", type=int, default=300, help="number of random systems")
    parser.add_argument("--model", type=Path, help="the model of the challenge of 2017")
    given = parser.parse_args()
    print(f"{'problems':18}{'number':>7}" + "".join(f"{each:>9}" for each in COLUMNS) + f"{'CPU':>10}")
    for name, solve in GROUPS.items():
        started = time.process_time()
        print(row(name, [solve(case) for case in DESIGN.get(name, ())], time.process_time() - started))
    started = time.process_time()
    print(row("random", list(random_orders(given.random)), time.process_time() - started))
    if given.model:
        challenge(given.model)


if __name__ == "__main__":
    main()
