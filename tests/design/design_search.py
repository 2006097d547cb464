"""Problems for solvers, judged by the analysis alone."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction

from design_systems import system_of, with_chain

from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.changes.apply import apply
from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.optimize.problem import DesignEvaluation, Feasibility, Goal, Problem, SearchResult
from amalthea_uros.design.optimize.space import Candidate, Choice, DecisionKind, PriorityOrder, Space
from amalthea_uros.perf.activities import Communication
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.settings import Settings

Measure = Callable[[Analysis], Fraction | int | None]


def problem_of(system: System, space: Space, measure: Measure | None = None, settings: Settings | None = None) -> Problem:
    """The problem to meet all limits, and to minimise something.

    Parameters
    ----------
    measure : by default the number of changes
    """
    configuration = Configuration(system, settings or Settings())

    def configure(design: Candidate) -> Configuration:
        return apply(*configuration, design)

    def evaluate(designs: Sequence[Candidate]) -> list[DesignEvaluation]:
        return [judged(design, analyze_system(*configure(design)), measure) for design in designs]

    goal = Goal(name="value" if measure else "changes")
    return Problem(present=configuration, space=space, goals=(goal,), configure=configure, evaluate=evaluate)


def judged(design: Candidate, analysis: Analysis, measure: Measure | None) -> DesignEvaluation:
    """What the analysis says of a design."""
    summary = analysis.summary
    feasible = Feasibility.NO if summary.missed else Feasibility.UNKNOWN if summary.unknown else Feasibility.YES
    value = measure(analysis) if measure else len(design)
    late = {each.name: max(0, -each.margin) for each in analysis.processes if each.margin is not None and each.margin < 0}
    return DesignEvaluation(
        candidate=design,
        feasible=feasible,
        violations=late,
        values=(None if value is None else Fraction(value),),
        is_exact=True,
    )


def order_space(names: Sequence[str]) -> PriorityOrder:
    return PriorityOrder(scheduler="core", tasks=tuple(names), numbers=tuple(range(len(names), 0, -1)))


def order_problem(tasks: list[dict], **more) -> Problem:
    """The priorities of tasks that are in an order that means nothing."""
    return problem_of(system_of(tasks, **more), Space(orders=(order_space([task["name"] for task in reversed(tasks)]),)))


def orders_of(problem: Problem, found: SearchResult) -> set[tuple[str, ...]]:
    """The orders that were found, the most important task first."""
    (order,) = problem.space.orders
    present = dict(zip(order.tasks, order.numbers, strict=True))
    numbers = [present | {change.object: int(change.value) for change in each.candidate} for each in found.best]
    return {tuple(sorted(each, key=lambda name, each=each: -each[name])) for each in numbers}


QUANTITIES = {
    "mrt": LatencyQuantity.MAX_REACTION_TIME,
    "mrrt": LatencyQuantity.MAX_REDUCED_REACTION_TIME,
    "mrda": LatencyQuantity.MAX_REDUCED_DATA_AGE,
}


def offsets(tasks):
    """All offsets of all tasks but the first."""
    return Space(
        choices=tuple(
            Choice(
                object=task["name"], key="offset", kind=DecisionKind.OFFSET, options=tuple(f"{n} us" for n in range(task["T"]))
            )
            for task in tasks
        )
    )


def offset_problem(case: dict) -> Problem:
    system = system_of([task | {"O": 0} for task in case["tasks"]], case["priority_order"])
    settings = Settings(communication=Communication.LET) if case["communication"] == "LET" else None
    space = offsets(case["tasks"][1:])
    if "chain" not in case:
        return problem_of(system, space, lambda analysis: analysis[case["target"]].wcrt)
    quantity = QUANTITIES[case["metric"]]
    built = with_chain(system, case["chain"])
    return problem_of(built, space, lambda analysis: analysis.chains["chain"].value(quantity).value, settings)


def mapping_problem(tasks: Sequence[dict], cores: Sequence[str], goal: str = "load", **more) -> Problem:
    """Tasks that may be on any core, all on the first one at present, with deadline-monotonic priorities."""
    order = [task["name"] for task in sorted(tasks, key=lambda task: task["D"])]
    choices = tuple(Choice(object=task["name"], key="core", kind=DecisionKind.CORE, options=tuple(cores)) for task in tasks)
    measure = (lambda analysis: max(core.worst for core in analysis.processors)) if goal == "load" else None
    problem = problem_of(system_of(tasks, order, cores=cores, **more), Space(choices=choices), measure)
    return replace(problem, goals=(Goal(name=goal),))


def cores_of(case: dict) -> list[str]:
    return [f"core {number}" for number in range(case["cores"])]
