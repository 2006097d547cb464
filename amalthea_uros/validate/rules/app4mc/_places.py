"""Where software is executed and stored, according to the mapping model."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.metamodel.classes import (
    ISRAllocation,
    Label,
    MemoryMapping,
    PhysicalSectionMapping,
    ProcessingUnit,
    Runnable,
    RunnableAllocation,
    Scheduler,
    TaskAllocation,
)
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.execution import executing
from amalthea_uros.validate.scheduling import responsibilities

#: The places of each mapped object, as an ordered set (a dictionary without values).
Places = dict[Element, dict[Element, None]]


def memories(context: Context) -> Places:
    """The memories of labels: those of their own mappings, or else those of their section."""
    sections = _gathered(
        (part, mapping.memory) for mapping in context.all(PhysicalSectionMapping) for part in (*mapping.origin, *mapping.labels)
    )
    labels = _gathered(
        (label, memory)
        for label in context.all(Label)
        if label.section is not None
        for memory in sections.get(label.section, ())
    )
    own = _gathered((mapping.abstract_element, mapping.memory) for mapping in context.all(MemoryMapping))
    return labels | sections | own


def schedulers(context: Context) -> Places:
    """The schedulers of tasks and runnables, and the interrupt controllers of ISRs."""
    tasks = _gathered((allocation.task, allocation.scheduler) for allocation in context.all(TaskAllocation))
    isrs = _gathered((allocation.isr, allocation.controller) for allocation in context.all(ISRAllocation))
    runnables = _gathered((allocation.entity, allocation.scheduler) for allocation in context.all(RunnableAllocation))
    return _with_runnables(tasks | isrs, runnables, context)


def cores(context: Context) -> Places:
    """The processing units on which processes and runnables may run."""

    def served(scheduler: Scheduler | None, affinity: Iterable[ProcessingUnit] = ()) -> list[ProcessingUnit]:
        wanted = set(affinity)
        found = responsibilities(context).get(scheduler, []) if scheduler is not None else []
        return [core for core in found if core in wanted or not wanted]

    tasks = _gathered((a.task, core) for a in context.all(TaskAllocation) for core in served(a.scheduler, a.affinity))
    isrs = _gathered((a.isr, core) for a in context.all(ISRAllocation) for core in served(a.controller))
    runnables = _gathered((a.entity, core) for a in context.all(RunnableAllocation) for core in served(a.scheduler))
    return _with_runnables(tasks | isrs, runnables, context)


def _with_runnables(processes: Places, stated: Places, context: Context) -> Places:
    """Add the runnables, by their own allocations, or else by those of the processes that execute them."""
    running = _gathered(
        (runnable, place)
        for runnable in context.all(Runnable)
        for process in executing(runnable, context)
        for place in processes.get(process, ())
    )
    return processes | running | stated


def _gathered(pairs: Iterable[tuple[Element | None, Element | None]]) -> Places:
    found: Places = {}
    for thing, place in pairs:
        if thing is not None and place is not None:
            found.setdefault(thing, {})[place] = None
    return found
