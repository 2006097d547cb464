"""How long processes execute."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import isfinite

from amalthea_uros._internal.graphs import bottom_up, circles
from amalthea_uros.metamodel import classes as am
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.execution import called, callers, waited_for
from amalthea_uros.validate.quantities import bounds
from amalthea_uros.validate.rule import model_rule
from amalthea_uros.validate.scheduling import units
from amalthea_uros.validate.wording import listed


@model_rule("TIM-TICKS", am.Ticks)
def _check_ticks(element: am.Ticks, context: Context) -> Iterator[str]:
    if element.default is not None:
        return
    stated = {entry.key for entry in element.extended if entry.value is not None}
    if not stated:
        yield "the ticks have no value"
    elif missing := [unit for unit in units(element, context) if unit.definition not in stated]:
        yield f"the ticks have no value for {listed(missing)}"


@model_rule("TIM-UNIT", am.ExecutionNeed)
def _check_unit(element: am.ExecutionNeed, context: Context) -> Iterator[str]:
    types = context.once(_types)
    for key in (entry.key or "" for entry in element.needs):
        if types and all(not _has_cost(kind, key) for kind in types):
            yield f"need {key!r} is not a feature category of any processing unit in use"
        elif missing := [unit for unit in units(element, context) if not _has_cost(unit.definition, key)]:
            yield f"the cost of need {key!r} is not defined for {listed(missing)}"


def _types(context: Context) -> set[am.ProcessingUnitDefinition | None]:
    return {unit.definition for unit in context.all(am.ProcessingUnit)}


def _has_cost(definition: am.ProcessingUnitDefinition | None, need: str) -> bool:
    """Whether it is defined how many ticks a unit of a need takes on a type of processing unit."""
    if need == "Instructions":
        return True  # one instruction per tick if nothing else is defined
    features = definition.features if definition is not None else ()
    return any(
        isinstance(feature.container, am.HwFeatureCategory)
        and feature.container.name == need
        and feature.value
        and isfinite(feature.value)
        for feature in features
    )


@model_rule("TIM-BOUNDS", am.IDiscreteValueDeviation)
def _check_bounds(element: am.IDiscreteValueDeviation, context: Context) -> Iterator[str]:
    for bound, side in zip(bounds(element), ("lower", "upper"), strict=True):
        if bound is None:
            yield f"the {type(element).__name__} has no {side} bound"


@model_rule("TIM-DISTRIBUTION", am.DiscreteValueWeibullEstimatorsDistribution)
def _check_distribution(element: am.DiscreteValueWeibullEstimatorsDistribution, context: Context) -> Iterator[str]:
    names = ("lower_bound", "average", "upper_bound", "p_remain_promille")
    lower, average, upper, remaining = (element.effective(name) for name in names)
    if not lower < average < upper:
        yield f"the average {average} is not strictly between the bounds {lower} and {upper}"
    if not 0 < remaining < 1000:
        yield f"the probability of exceeding the upper bound is {remaining} per mille, but must be greater than 0 and less than 1000"


@model_rule("TIM-DEMAND", am.Process)
def _check_demand(element: am.Process, context: Context) -> Iterator[str]:
    if isinstance(element, am.Task | am.ISR) and element not in context.once(_demanding):
        yield f"{element.name!r} has no execution time, and neither have the runnables that it calls"


def _demanding(context: Context) -> set[am.IExecutable]:
    """The processes and runnables that take time, directly or through the runnables that they call."""
    ticks = (item for item in context.all(am.Ticks) if item.default is not None or item.extended)
    needs = (item for item in context.all(am.ExecutionNeed) if item.needs)
    holders = (item.enclosing(am.IExecutable) for item in (*ticks, *needs))
    return set(bottom_up((holder for holder in holders if holder is not None), lambda item: callers(item, context)))


@model_rule("TIM-LOOP", am.WhileLoop)
def _check_loop(element: am.WhileLoop, context: Context) -> Iterator[str]:
    yield "the maximum number of iterations is unknown"


@model_rule("TIM-WEIGHTS", am.ProbabilitySwitch)
def _check_weights(element: am.ProbabilitySwitch, context: Context) -> Iterator[str]:
    if element.entries and not any((entry.probability or 0) > 0 for entry in element.entries):
        yield "no branch has a probability greater than 0"


@model_rule("TIM-WAIT", am.WaitEvent)
def _check_wait(element: am.WaitEvent, context: Context) -> Iterator[str]:
    events = element.event_mask.events if element.event_mask is not None else []
    what = f" for {listed(events)}" if events else ""
    yield f"the maximum waiting time{what} is unknown"


#: Longer call paths are shortened.
_MOST = 12
#: Runnables of a circle in which a path is searched from each of them: the time is a square of their number.
_LARGEST_CIRCLE = 100


@model_rule("TIM-RECURSION", am.Runnable)
def _check_recursion(element: am.Runnable, context: Context) -> Iterator[str]:
    circle = context.once(_circles).get(element)
    if circle is None:
        return
    if len(circle) > _LARGEST_CIRCLE:
        yield f"{element.name!r} calls itself, through {len(circle) - 1:,} other runnables that do so, too"
        return
    # The first caller of each runnable in a search from this one.
    first: dict[am.Runnable, am.Runnable] = {}
    pending = [element]
    while element not in first:
        caller = pending.pop()
        for callee in waited_for(caller, context):
            if callee in circle and callee not in first:
                first[callee] = caller
                pending.append(callee)
    path = [element, first[element]]
    while path[-1] is not element:
        path.append(first[path[-1]])
    names = [runnable.name or "" for runnable in reversed(path)]
    if len(names) > _MOST:
        names[_MOST - 2 : -1] = ["..."]
    yield f"{element.name!r} calls itself: {' -> '.join(names)}"


def _circles(context: Context) -> dict[am.Runnable, set[am.Runnable]]:
    found = circles(context.all(am.Runnable), lambda caller: waited_for(caller, context))
    return {runnable: circle for circle in found for runnable in circle}


@model_rule("TIM-UNREACHABLE", am.Runnable)
def _check_unreachable(element: am.Runnable, context: Context) -> Iterator[str]:
    if element not in context.once(_executed):
        yield f"runnable {element.name!r} is not executed by any process"


def _executed(context: Context) -> set[am.IExecutable]:
    """Everything that processes execute or cause to be executed."""
    caused: dict[am.IExecutable | None, list[am.Runnable | None]] = {}
    for call in context.all(am.ServerCall):
        caused.setdefault(call.enclosing(am.IExecutable), []).append(call.server_runnable)
    for request in context.all(am.AsynchronousServerCall):
        caused.setdefault(request.enclosing(am.IExecutable), []).append(request.result_runnable)
    for write in context.all(am.SenderReceiverWrite):
        caused.setdefault(write.enclosing(am.IExecutable), []).extend(write.notified_runnables)

    def next_to(item: am.IExecutable) -> Iterator[am.IExecutable]:
        yield from called(item, context)
        yield from (runnable for runnable in caused.get(item, ()) if runnable is not None)

    starts: Sequence[am.IExecutable] = context.all(am.Process)
    return set(bottom_up(starts, next_to))
