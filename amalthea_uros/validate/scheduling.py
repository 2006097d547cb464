"""Who decides for a process: its scheduler, policy, priority and processing units."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import takewhile

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.execution import executing


def policy(scheduler: am.Scheduler | None) -> str | None:
    """The name of the policy of a scheduler: until 1.2 that of a class, since 2.0 that of a definition."""
    definition = scheduler.definition if scheduler is not None else None
    if definition is not None:
        return definition.name or None
    algorithm = scheduler.scheduling_algorithm if isinstance(scheduler, am.TaskScheduler | am.InterruptController) else None
    return type(algorithm).__name__ if algorithm is not None else None


#: The policy that takes no decisions.
GROUPING = "Grouping"


def deciding(scheduler: am.TaskScheduler | None) -> am.TaskScheduler | None:
    """The scheduler that decides for those below another one: a grouping leaves that to its parent."""
    return next((one for one in _upwards(scheduler) if policy(one) != GROUPING), None)


def _upwards(scheduler: am.Scheduler | None) -> Iterator[am.TaskScheduler]:
    seen: set[am.Scheduler] = set()
    while isinstance(scheduler, am.TaskScheduler) and scheduler not in seen:
        seen.add(scheduler)
        yield scheduler
        scheduler = parent_of(scheduler)


def parent_of(scheduler: am.TaskScheduler) -> am.TaskScheduler | None:
    """The scheduler above."""
    return scheduler.parent_association.parent if scheduler.parent_association is not None else None


def parameter(container: am.ISchedulingParameterContainer, name: str, scheduler: am.Scheduler | None) -> am.Value | None:
    """The value of a parameter that a scheduler takes: what is stated, or else the default of its definition."""
    stated = [entry for entry in container.scheduling_parameters if isinstance(entry, am.SchedulingParameter)]
    value = next((entry.value for entry in stated if entry.key is not None and entry.key.name == name), None)
    definition = scheduler.definition if scheduler is not None else None
    if value is not None or definition is None:
        return value
    return next((key.default_value for key in definition.process_parameters if key.name == name), None)


def priority(allocation: am.TaskAllocation) -> int | None:
    """The priority of a task, or of the group in which it is; None if there is none."""
    scheduler = deciding(allocation.scheduler)
    below = takewhile(lambda one: one is not scheduler, _upwards(allocation.scheduler))
    groups = [one.parent_association for one in below if one.parent_association is not None]
    return next((found for one in (allocation, *groups) if (found := _priority(one, scheduler)) is not None), None)


def _priority(container: am.ISchedulingParameterContainer, scheduler: am.TaskScheduler | None) -> int | None:
    for stated in container.scheduling_parameters:
        if isinstance(stated, am.SchedulingParameters):  # until 1.2
            return stated.priority
    value = parameter(container, "priority", scheduler)
    return value.value if isinstance(value, am.IntegerObject | am.LongObject | am.BigIntegerObject) else None


def cores(context: Context) -> Mapping[am.Process, frozenset[am.ProcessingUnit]]:
    """The processing units on which each process may run; only of processes that have any."""
    return context.once(_cores)


def responsibilities(context: Context) -> Mapping[am.Scheduler, list[am.ProcessingUnit]]:
    """The processing units of each scheduler: its own, or else those of the next scheduler above that has some."""
    return context.once(_responsibilities)


def _responsibilities(context: Context) -> dict[am.Scheduler, list[am.ProcessingUnit]]:
    found: dict[am.Scheduler, list[am.ProcessingUnit]] = {}
    for allocation in context.all(am.SchedulerAllocation):
        if allocation.scheduler is not None and allocation.responsibility:
            found.setdefault(allocation.scheduler, []).extend(_real(allocation.responsibility))
    for scheduler in context.all(am.TaskScheduler):
        without: list[am.TaskScheduler] = []
        above: am.TaskScheduler | None = scheduler
        while above is not None and above not in found:
            found[above] = []  # ends a circle
            without.append(above)
            above = parent_of(above)
        for each in without:
            found[each] = [] if above is None else found[above]
    return found


def _cores(context: Context) -> dict[am.Process, frozenset[am.ProcessingUnit]]:
    served = responsibilities(context)
    found: dict[am.Process, set[am.ProcessingUnit]] = {}
    for place in context.all(am.TaskAllocation):
        if place.task is not None:
            here = set(served.get(place.scheduler, ())) if place.scheduler is not None else set()
            wanted = set(place.affinity)
            found.setdefault(place.task, set()).update(here & wanted if wanted else here)
    for interrupt in context.all(am.ISRAllocation):
        if interrupt.isr is not None and interrupt.controller is not None:
            found.setdefault(interrupt.isr, set()).update(served.get(interrupt.controller, ()))
    return {process: frozenset(units) for process, units in found.items() if units}


def _real(units: Iterable[am.ProcessingUnit]) -> Iterator[am.ProcessingUnit]:
    return (unit for unit in units if unit.unresolved is None)


def units(item: Element, context: Context) -> list[am.ProcessingUnit]:
    """The processing units on which something is executed, by their names."""
    known = cores(context)
    found = {unit for process in executing(item, context) for unit in known.get(process, ())}
    return sorted(found, key=name_of)
