"""Exact priorities: all orders in which each task meets its deadline, found from the lowest priority up.

Where a response time depends only on the set of tasks with higher priority, an order is excluded as soon as a task misses its deadline
directly above the ones that were placed below it (Audsley 2001): every order with this beginning is excluded with it. What remains is
judged by the full analysis, chains included. Elsewhere, all orders are judged if they are not too many.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain, islice, permutations, product

from amalthea_uros.analyze.priorities.orders import Order, PriorityOrders
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.optimize.judged import Judged
from amalthea_uros.design.optimize.problem import Conclusion, Problem, SearchResult
from amalthea_uros.design.optimize.space import UNCHANGED, Candidate, PriorityOrder, candidate

#: At most this many designs are judged.
MAX_DESIGNS = 1000


def solve_priorities(problem: Problem, designs: int = MAX_DESIGNS) -> SearchResult | None:
    """The best order of priorities on each core; None if something else may change, or orders cannot be judged one core at a time.

    Parameters
    ----------
    designs : at most so many are judged, beside the present one
    """
    space = problem.space
    if not space.orders or any(len(choice.options) > 1 for choice in space.choices):
        return None
    analysis = analyze_system(*problem.present)
    cores = [orders for each in space.orders if (orders := _orders_of(each, analysis)) is not None]
    if len(cores) < len(space.orders):
        return None
    for orders in cores:
        if reason := _refutation(orders):
            proof = f"on {orders.core!r}, {reason}"
            return SearchResult(best=(), front=(), conclusion=Conclusion.NONE, tried=0, excluded=space.size, proof=proof)
    is_independent = all(orders.is_independent for orders in cores)
    judged = Judged(problem)
    judged.judge([UNCHANGED])
    candidates = _candidates(cores, space.orders, analysis, is_everything=not is_independent and space.size <= designs)
    judged.judge(islice(candidates, designs))
    if next(candidates, None) is not None:
        return judged.concluded("", ended=f"{len(judged)} designs were judged")
    return judged.concluded(_proof(cores, is_independent, judged, space.size), excluded=space.size - len(judged))


def _orders_of(order: PriorityOrder, analysis: Analysis) -> PriorityOrders | None:
    """The orders of the tasks of a scheduler; None if they are on several cores, or cannot be judged."""
    scheduled = analysis.solution.context.scheduled
    tasks = [scheduled[name] for name in order.tasks if name in scheduled]
    cores = {item.core for item in tasks}
    if len(tasks) < len(order.tasks) or len(cores) != 1:
        return None
    found = PriorityOrders(cores.pop(), tasks, analysis, order.numbers)
    return None if found.obstacle() else found


def _refutation(orders: PriorityOrders) -> str:
    """Why no order meets all deadlines; "" if there may be one."""
    if overload := orders.overload():
        return overload
    if not orders.is_independent:
        return ""
    order, unfitting = next(orders.fitting())
    return orders.dead_end(order, unfitting) if unfitting else ""


def _candidates(
    cores: Sequence[PriorityOrders], spaces: Sequence[PriorityOrder], analysis: Analysis, is_everything: bool
) -> Iterator[Candidate]:
    """The designs whose orders fit on each core, or all; each one once."""
    present = {
        f"{name}.priority": str(analysis.solution.context.scheduled[name].priority) for each in spaces for name in each.tasks
    }
    fitting = [(order for order, unfitting in orders.fitting() if not unfitting) for orders in cores]
    combined: Iterator[tuple[Order, ...]] = _product(fitting)
    if is_everything:
        combined = chain(combined, product(*(permutations(each.tasks) for each in spaces)))
    seen: set[Candidate] = set()
    for combination in combined:
        changes = [
            change for each, order in zip(spaces, combination, strict=True) for change in each.changes(tuple(reversed(order)))
        ]
        found = candidate(changes, present)
        if found not in seen:
            seen.add(found)
            yield found


def _product(fitting: Sequence[Iterator[list[str]]]) -> Iterator[tuple[Order, ...]]:
    """Each combination of the orders; those of the first core one after the other, without finding all of them at first."""
    first, *others = fitting
    rest = list(product(*([*islice(each, MAX_DESIGNS)] for each in others)))
    for order in first:
        for more in rest:
            yield (order, *more)


def _proof(cores: Sequence[PriorityOrders], is_independent: bool, judged: Judged, size: int) -> str:
    """Why no other order is better; "" if that is not known."""
    if len(judged) == size:
        return f"all {size} orders were judged"
    if not is_independent or not all(orders.is_certain for orders in cores):
        return ""
    return (
        f"{len(judged)} orders were judged; in the other {size - len(judged)} a task misses its deadline whatever the order above it "
        "(Audsley 2001)"
    )
