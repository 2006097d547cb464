"""The load of processing units in the worst case, as far as it is known.

Of branches the longest one counts. Processes of which the demand or the rate of activations is not known are left out, so that the
load is at least what is told here.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from math import isfinite

from amalthea_uros._internal.graphs import bottom_up
from amalthea_uros.metamodel.classes import (
    ActivityGraph,
    ActivityGraphItem,
    ArrivalCurveStimulus,
    Counter,
    EnforcedMigration,
    ExecutionNeed,
    Group,
    HwFeatureCategory,
    IActivityGraphItemContainer,
    IExecutable,
    InterProcessStimulus,
    InterProcessTrigger,
    ModeSwitch,
    PeriodicBurstStimulus,
    PeriodicStimulus,
    PeriodicSyntheticStimulus,
    ProbabilitySwitch,
    Process,
    ProcessingUnit,
    ProcessingUnitDefinition,
    RelativePeriodicStimulus,
    Runnable,
    RunnableCall,
    SingleStimulus,
    Stimulus,
    Switch,
    Ticks,
    WaitEvent,
    WhileLoop,
)
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.magnitudes import picoseconds
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.execution import executing, order, times
from amalthea_uros.validate.quantities import bounds, clock
from amalthea_uros.validate.scheduling import cores

#: Picoseconds in a second.
_SECOND = 10**12

#: Ticks, exactly; nearly always they are whole numbers, which are much faster.
_Number = int | Fraction


def loads(context: Context) -> Mapping[ProcessingUnit, Mapping[Process, Fraction]]:
    """What each process demands of its processing unit, where it has only one; 1 is all of it."""
    return context.once(_loads)


def _loads(context: Context) -> dict[ProcessingUnit, dict[Process, Fraction]]:
    found: dict[ProcessingUnit, dict[Process, Fraction]] = {}
    demands: dict[ProcessingUnitDefinition | None, dict[IExecutable, _Number]] = {}
    for process, units in cores(context).items():
        if len(units) > 1:
            continue
        (unit,) = units
        if unit.definition not in demands:
            demands[unit.definition] = _demands(unit.definition, context)
        ticks, rate, frequency = demands[unit.definition].get(process), rates(context).get(process), clock(unit)
        if ticks is not None and rate is not None and frequency is not None:
            found.setdefault(unit, {})[process] = ticks * _SECOND * rate / frequency
    return found


# Demand


def _demands(definition: ProcessingUnitDefinition | None, context: Context) -> dict[IExecutable, _Number]:
    """What each process and runnable takes in ticks of a processing unit; of processes, on average over many jobs."""
    found: dict[IExecutable, _Number] = {}
    for executable in order(context):
        ticks = _of_graph(executable.activity_graph, definition, found)
        if ticks is not None:
            found[executable] = ticks
    return found


def _of_graph(
    graph: ActivityGraph | None, definition: ProcessingUnitDefinition | None, known: Mapping[IExecutable, _Number]
) -> _Number | None:
    if graph is None:
        return 0
    found: dict[Element, _Number] = {}
    # Inner items before the outer ones, which are made of them.
    for item in reversed(list(_items(graph))):
        ticks: _Number | None
        match item:
            case Ticks():
                ticks = _ticks(item, definition)
            case ExecutionNeed():
                ticks = _needs(item, definition)
            case RunnableCall():
                ticks = _call(item, known)
            case WhileLoop() | WaitEvent() | EnforcedMigration():
                return None
            case Switch() | ModeSwitch() | ProbabilitySwitch():
                ticks = max((found[part] for part in item.contents() if part in found), default=0)
            case _:
                ticks = sum(found[part] for part in item.contents() if part in found)
        if ticks is None:
            return None
        found[item] = ticks
    return found[graph]


def _items(graph: ActivityGraph) -> Iterator[Element]:
    """What is in a graph, without what its items consist of themselves."""
    pending: list[Element] = [graph]
    while pending:
        item = pending.pop()
        yield item
        if isinstance(item, _HOLDERS):
            pending.extend(part for part in item.contents() if isinstance(part, _ITEMS))


_HOLDERS = (IActivityGraphItemContainer, Switch, ModeSwitch, ProbabilitySwitch)
_ITEMS = (IActivityGraphItemContainer, ActivityGraphItem)


def _ticks(item: Ticks, definition: ProcessingUnitDefinition | None) -> _Number | None:
    extended = {entry.key: entry.value for entry in item.extended if entry.value is not None}
    upper = bounds(extended.get(definition, item.default))[1]
    return upper if upper is None or isinstance(upper, int) else Fraction(upper)


def _needs(item: ExecutionNeed, definition: ProcessingUnitDefinition | None) -> Fraction | None:
    total = Fraction(0)
    for entry in item.needs:
        upper, per_unit = bounds(entry.value)[1], ticks_per_unit(definition, entry.key or "")
        if upper is None or per_unit is None:
            return None
        total += Fraction(upper) * per_unit
    return total


def ticks_per_unit(definition: ProcessingUnitDefinition | None, need: str) -> Fraction | None:
    """What a unit of an execution need takes on a type of processing unit; None if nothing says it."""
    for feature in definition.features if definition is not None else ():
        category = feature.container
        if isinstance(category, HwFeatureCategory) and category.name == need and feature.value and isfinite(feature.value):
            value = Fraction(feature.value)
            return 1 / value if (feature.name or "").startswith("IPC") else value
    # Where nothing else is stated, an instruction takes a tick.
    return Fraction(1) if need == "Instructions" else None


def _call(call: RunnableCall, known: Mapping[IExecutable, _Number]) -> _Number | None:
    ticks = known.get(call.runnable) if isinstance(call.runnable, Runnable) and call.runnable.unresolved is None else None
    if ticks is None:
        return None
    # Only of calls that stand in a process itself is it known which jobs leave them out.
    often = _prescaler(call.counter) if _is_in_each_job(call) else 1
    return ticks * times(call) if often == 1 else Fraction(ticks * times(call)) / often


def _is_in_each_job(item: Element) -> bool:
    holder = item.container
    while isinstance(holder, Group):
        holder = holder.container
    return isinstance(holder, ActivityGraph) and isinstance(holder.container, Process)


def _prescaler(counter: Counter | None) -> int:
    return max(1, counter.prescaler or 1) if counter is not None else 1


# Activations


def rates(context: Context) -> Mapping[Process, Fraction]:
    """How often each process is activated in a picosecond, at most and in the long run; only of processes of which it is known."""
    return context.once(_rates)


def _rates(context: Context) -> dict[Process, Fraction]:
    triggers = _triggers(context)
    found: dict[Process, Fraction] = {}

    def causes(process: Process) -> Iterator[Process]:
        for stimulus in process.stimuli:
            for trigger in triggers.get(stimulus, ()):
                yield from executing(trigger, context)

    for process in bottom_up(context.all(Process), causes):
        each = [_rate(stimulus, triggers, found, context) for stimulus in process.stimuli]
        if each and None not in each:
            found[process] = sum((rate for rate in each if rate is not None), Fraction(0))
    return found


def _triggers(context: Context) -> dict[Stimulus, list[InterProcessTrigger]]:
    found: dict[Stimulus, list[InterProcessTrigger]] = {}
    for trigger in context.all(InterProcessTrigger):
        if trigger.stimulus is not None:
            found.setdefault(trigger.stimulus, []).append(trigger)
    return found


def _rate(
    stimulus: Stimulus,
    triggers: Mapping[Stimulus, Iterable[InterProcessTrigger]],
    known: Mapping[Process, Fraction],
    context: Context,
) -> Fraction | None:
    match stimulus:
        case PeriodicStimulus():
            return _per(1, picoseconds(stimulus.recurrence))
        case RelativePeriodicStimulus():
            return _per(1, bounds(stimulus.next_occurrence)[0])
        case PeriodicSyntheticStimulus():
            return _per(len(stimulus.occurrence_times), picoseconds(stimulus.recurrence))
        case PeriodicBurstStimulus():
            return _per(_in_burst(stimulus), picoseconds(stimulus.recurrence))
        case ArrivalCurveStimulus():
            spans = [
                (entry.effective("number_of_occurrences") - 1, picoseconds(entry.lower_time_border))
                for entry in stimulus.entries
            ]
            return min((rate for steps, span in spans if steps > 0 and (rate := _per(steps, span)) is not None), default=None)
        case SingleStimulus():
            return Fraction(0)
        case InterProcessStimulus():
            return _triggered(stimulus, triggers.get(stimulus, ()), known, context)
    return None


def _per(count: int | None, time: float | None) -> Fraction | None:
    return Fraction(count) / Fraction(time) if count is not None and time is not None and time > 0 else None


def _in_burst(stimulus: PeriodicBurstStimulus) -> int | None:
    """How many occurrences a burst has: those behind its length are cut off."""
    count: int = stimulus.effective("occurrence_count")
    length, distance = picoseconds(stimulus.burst_length), picoseconds(stimulus.occurrence_min_distance)
    if length is None:
        return None
    return min(count, -(-max(length, 1) // distance)) if distance else count


def _triggered(
    stimulus: InterProcessStimulus,
    triggers: Iterable[InterProcessTrigger],
    known: Mapping[Process, Fraction],
    context: Context,
) -> Fraction | None:
    total = None
    for trigger in triggers:
        for process, count in executing(trigger, context).items():
            if process not in known:
                return None
            total = (total or 0) + known[process] * count / _prescaler(trigger.counter)
    return None if total is None else total / _prescaler(stimulus.counter)
