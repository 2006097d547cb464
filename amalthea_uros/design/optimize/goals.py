"""What is better: the values that a search minimises."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.design.changes.change import split_target
from amalthea_uros.design.optimize.problem import Goal
from amalthea_uros.design.optimize.quantities import AmountKind, Figures, Limit, check_quantity, dimension
from amalthea_uros.design.optimize.space import Candidate
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.constraints import LatencyConstraint, LatencyKind
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.timing.scheduling.allocation import allocated_cores
from amalthea_uros.units import Time

FORM, EXAMPLE = "a goal or OBJECT.QUANTITY", "factor-to-output.max_reduced_reaction_time"

#: The number of changed values, which needs no analysis.
CHANGES = "changes"


@dataclass(frozen=True, slots=True, kw_only=True)
class GoalScale:
    """What goals are computed with.

    Attributes
    ----------
    latencies : the limited latencies with their limits; of all chains with their present values if none is limited
    """

    figures: Figures
    latencies: tuple[Limit, ...]


def _latency(analysis: Analysis, scale: GoalScale) -> Fraction | None:
    """The largest latency of a chain relative to its limit, or to its present value."""
    return _largest(
        None
        if (upper := limit.range(analysis, scale.figures).upper) is None or not limit.maximum
        else Fraction(upper) / limit.maximum
        for limit in scale.latencies
    )


def _load(analysis: Analysis, _scale: GoalScale) -> Fraction | None:
    """The largest worst-case load of a core."""
    return _largest(core.worst for core in analysis.processors)


def _balance(analysis: Analysis, _scale: GoalScale) -> Fraction | None:
    """The difference of the largest and the smallest load of the cores that can execute something."""
    used = {core for cores in allocated_cores(analysis.solution.context.system).values() for core in cores}
    loads = [core.worst for core in analysis.processors if core.name in used]
    known = [load for load in loads if load is not None]
    return max(known) - min(known) if known and len(known) == len(loads) else None


def _jitter(analysis: Analysis, _scale: GoalScale) -> Fraction | None:
    """The largest difference of the response times of a task."""
    metrics = [process.metrics.get(JobMetric.RESPONSE_TIME) for process in analysis.processes]
    return _largest(None if metric is None or metric.jitter is None else Fraction(metric.jitter) for metric in metrics)


#: The unit and the value of each.
_NAMED: Mapping[str, tuple[str, Callable[[Analysis, GoalScale], Fraction | None]]] = {
    "latency": ("", _latency),
    "load": ("", _load),
    "balance": ("", _balance),
    "jitter": ("ps", _jitter),
}
#: The goals that have names.
GOALS = (*_NAMED, CHANGES)
_CHANGES = Goal(name=CHANGES)


def goals_of(names: Sequence[str], system: System) -> tuple[Goal, ...]:
    """The goals of a search; without any, the fewest changes count most. The number of changes always counts in the end.

    Raises
    ------
    InvalidArgumentError : a name is not that of a goal or quantity.
    """
    found = [_goal(name, system) for name in dict.fromkeys(names or (CHANGES, "latency", "load"))]
    if not any(goal.name == CHANGES for goal in found):
        found.append(_CHANGES)
    return tuple(found)


def _goal(name: str, system: System) -> Goal:
    if name == CHANGES:
        return _CHANGES
    if name in _NAMED:
        return Goal(name=name, unit=_NAMED[name][0])
    if "." not in name:
        raise InvalidArgumentError(
            f"unknown goal {name!r}; expected one of {', '.join(GOALS)}, or OBJECT.QUANTITY, e.g. {EXAMPLE}"
        )
    obj, quantity = split_target(name, name, FORM, EXAMPLE)
    check_quantity(system, obj, quantity, name)
    return Goal(name=name, unit="ps" if dimension(quantity) is AmountKind.TIME else "")


def named_by(goals: Iterable[Goal]) -> frozenset[tuple[str, str]]:
    """The objects and quantities that goals name."""
    return frozenset(split_target(goal.name, goal.name, FORM, EXAMPLE) for goal in goals if goal.name not in GOALS)


def value_of(goal: Goal, analysis: Analysis, candidate: Candidate, scale: GoalScale) -> Fraction | None:
    """The value of a goal in a design; None if it is unknown."""
    if goal.name == CHANGES:
        return Fraction(len(candidate))
    if goal.name in _NAMED:
        return _NAMED[goal.name][1](analysis, scale)
    obj, quantity = split_target(goal.name, goal.name, FORM, EXAMPLE)
    upper = scale.figures.range(analysis, obj, quantity).upper
    return None if upper is None else Fraction(upper)


def latency_limits(analysis: Analysis, limits: Iterable[Limit], figures: Figures) -> tuple[Limit, ...]:
    """The limited latencies of chains; if there are none, the reaction times of all chains with their present values as limits."""
    system = analysis.solution.context.system
    found = [*(limit for limit in limits if limit.object in system.chains), *constraints_of(system)]
    return tuple(found or _present(analysis, figures))


_LIMITED = {
    LatencyKind.REACTION: LatencyQuantity.MAX_REDUCED_REACTION_TIME,
    LatencyKind.AGE: LatencyQuantity.MAX_REDUCED_DATA_AGE,
}


def constraints_of(system: System) -> Iterator[Limit]:
    """The limits of latencies of chains that a model states."""
    for constraint in system.constraints.constraints:
        if isinstance(constraint, LatencyConstraint) and constraint.maximum and constraint.chain in system.chains:
            yield Limit(object=constraint.chain, quantity=_LIMITED[constraint.kind], maximum=constraint.maximum)


def _present(analysis: Analysis, figures: Figures) -> Iterator[Limit]:
    for chain in analysis.chains:
        upper: Time | Fraction | None = figures.range(analysis, chain.name, LatencyQuantity.MAX_REDUCED_REACTION_TIME).upper
        if upper:
            yield Limit(object=chain.name, quantity=LatencyQuantity.MAX_REDUCED_REACTION_TIME, maximum=upper)


def _largest(values: Iterable[Fraction | None]) -> Fraction | None:
    """The largest value; None if one is unknown, or there is none."""
    found = list(values)
    known = [value for value in found if value is not None]
    return max(known) if known and len(known) == len(found) else None
