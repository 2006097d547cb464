"""A search for a better design in words: what may change, what must hold, and what the outcome proves."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros._internal.plural import counted
from amalthea_uros.design.optimize.goals import CHANGES
from amalthea_uros.design.optimize.problem import Conclusion, Feasibility, Goal
from amalthea_uros.design.optimize.quantities import AmountKind, Limit, dimension
from amalthea_uros.design.optimize.space import Choice, Space
from amalthea_uros.report.wording.cells import load_text
from amalthea_uros.services.optimize import Optimization
from amalthea_uros.units import number_text, time_text

#: More values of a choice are only counted.
_MOST_OPTIONS, _MOST_CHOICES = 6, 12
#: Larger numbers have an exponent.
_LONG = 10**15

_GOALS = {
    "latency": "the largest latency of a chain relative to its limit (latency)",
    "load": "the largest load of a core (load)",
    "balance": "the difference between the loads of the cores (balance)",
    "jitter": "the largest response-time jitter (jitter)",
    CHANGES: "the number of changed values (changes)",
}


def space_lines(space: Space) -> Iterator[str]:
    """What may change."""
    shown = space.choices[:_MOST_CHOICES]
    yield from map(_choice, shown)
    if len(space.choices) > len(shown):
        yield f"{counted(len(space.choices) - len(shown), 'other value')}"
    for order in space.orders:
        yield f"priorities on {order.scheduler}: any order of {counted(len(order.tasks), 'task')}"


def _choice(choice: Choice) -> str:
    options = ", ".join(choice.options[1 : _MOST_OPTIONS + 1])
    more = len(choice.options) - 1 - _MOST_OPTIONS
    return f"{choice.target} {choice.options[0]}: {options}" + (f" and {more} more" if more > 0 else "")


def limit_text(limit: Limit) -> str:
    """A limit, and what it is for."""
    maximum = load_text(limit.maximum) if dimension(limit.quantity) is AmountKind.SHARE else time_text(limit.maximum)  # type: ignore[arg-type]
    return f"{limit.target} {'<' if limit.is_below else '<='} {maximum}" + (f" ({limit.reason})" if limit.reason else "")


def goal_text(goal: Goal) -> str:
    """A goal in words."""
    return _GOALS.get(goal.name, goal.name)


def count_text(count: int) -> str:
    """A number of designs, which may be very large."""
    return f"{count:,}" if count < _LONG else number_text(count)


def closing_line(result: Optimization) -> str:
    """What the search found and what it proves."""
    search = result.search
    of = f"{search.tried:,} judged out of {count_text(result.space.size)}"
    match search.conclusion:
        case Conclusion.OPTIMAL if not search.best[0].candidate:
            return f"Nothing needs to change: the present design meets all {_demanded(result)}{_and_best(result)}"
        case Conclusion.OPTIMAL:
            proved = "" if search.best[0].is_exact and not search.undecided else " that is proved to meet all limits"
            return f"Optimal: no allowed design{proved} is better than proposal 1: {search.proof}"
        case Conclusion.NONE:
            return f"None exists: no allowed design meets all limits: {search.proof}"
        case Conclusion.BEST_FOUND:
            return f"Best found, not proved to be optimal: {_why_open(result)}; {of}"
    return f"None found, which proves nothing: {_why_open(result)}; {of}"


def _why_open(result: Optimization) -> str:
    """Why the search proves nothing."""
    search = result.search
    meet = "meets" if search.undecided == 1 else "meet"
    unknown = f"it is unknown whether {counted(search.undecided, 'design')} {meet} all limits" if search.undecided else ""
    return "; ".join(filter(None, (search.ended, unknown))) or "not all designs were judged"


def _demanded(result: Optimization) -> str:
    is_limited = result.limits or any(each.limit is not None for each in result.before.requirements)
    return "limits" if is_limited else "deadlines, and nothing else is demanded (add what must hold with --limit)"


def _and_best(result: Optimization) -> str:
    if result.goals[0].name == CHANGES:
        return "; to improve it, state a goal, e.g. --goal latency"
    return f", and none is better: {result.search.proof}"


def is_met(result: Optimization) -> bool:
    """Whether a design that meets all limits was found."""
    return any(each.feasible is Feasibility.YES for each in result.search.best)
