"""The mapping model."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from amalthea_uros.bridge.basics.codecs import PLAIN, reference, references
from amalthea_uros.bridge.basics.context import Building, Extracting
from amalthea_uros.bridge.basics.entries import ClassEntry, ClassTable
from amalthea_uros.bridge.basics.kinds import ObjectKind
from amalthea_uros.bridge.tables.parameters import Given, SchedulingDefinitions, extract_parameters
from amalthea_uros.metamodel import classes as am
from amalthea_uros.perf import mapping as perf
from amalthea_uros.perf.os import InterruptController, Scheduler
from amalthea_uros.perf.system import System

_PROCESS, _SCHEDULER, _CORES = reference(ObjectKind.PROCESS), reference(ObjectKind.SCHEDULER), references(ObjectKind.MODULE)
_DATA, _MEMORY, _CORE = reference(ObjectKind.DATA), reference(ObjectKind.MODULE), reference(ObjectKind.MODULE)

ISR_ALLOCATIONS = ClassTable(
    ClassEntry(perf.IsrAllocation, am.ISRAllocation, isr=_PROCESS, controller=_SCHEDULER, priority=PLAIN)
)
PLACEMENTS = ClassTable(
    ClassEntry(
        perf.Placement, am.MemoryMapping, element=("abstract_element", _DATA), memory=_MEMORY, address="memory_position_address"
    )
)


def build_mapping(system: System, definitions: SchedulingDefinitions) -> am.MappingModel:
    """The mapping of software to hardware."""
    context = definitions.context
    schedulers: list[Scheduler | InterruptController] = [*system.schedulers.values(), *system.interrupt_controllers.values()]
    return am.MappingModel(
        scheduler_allocation=[found for s in schedulers if (found := _scheduler_allocation(s, context)) is not None],
        task_allocation=[_task_allocation(allocation, system, definitions) for allocation in system.mapping.tasks],
        isr_allocation=[ISR_ALLOCATIONS.build(allocation, context) for allocation in system.mapping.isrs],
        memory_mapping=[PLACEMENTS.build(placement, context) for placement in system.mapping.placements],
    )


def _scheduler_allocation(scheduler: Scheduler | InterruptController, context: Building) -> am.SchedulerAllocation | None:
    context.at(scheduler)
    if not scheduler.cores and scheduler.executing_core is None:
        return None
    element: Any = context.find(ObjectKind.SCHEDULER, scheduler.name)
    return am.SchedulerAllocation(
        scheduler=element,
        responsibility=_CORES.build(scheduler.cores, context),
        executing_pu=_CORE.build(scheduler.executing_core, context),
    )


def _task_allocation(allocation: perf.TaskAllocation, system: System, definitions: SchedulingDefinitions) -> am.TaskAllocation:
    context = definitions.context
    task = system.processes.get(allocation.task)
    if task is not None:
        context.at(task)
    element = am.TaskAllocation(
        task=_PROCESS.build(allocation.task, context),
        scheduler=_SCHEDULER.build(allocation.scheduler, context),
        affinity=_CORES.build(allocation.cores, context),
    )
    scheduler = system.schedulers.get(allocation.scheduler)
    given = Given(allocation.priority, allocation.deadline, allocation.parameters)
    if task is not None:
        definitions.set_parameters(element, task, given, scheduler.policy if scheduler else None, of_process=True)
        if task.origin is not None:
            context.origins[element] = task.origin
    return element


def extract_mapping(mapping: am.MappingModel, context: Extracting) -> perf.Mapping:
    """The way back."""
    for left_out in (*mapping.runnable_allocation, *mapping.physical_section_mapping):
        context.leave_out(left_out)
    for placement in filter(_is_other, mapping.memory_mapping):
        context.leave_out(placement)
    return perf.Mapping(
        tasks=tuple(_extract_tasks(mapping.task_allocation, context)),
        isrs=ISR_ALLOCATIONS.extract_all(mapping.isr_allocation, context),
        placements=PLACEMENTS.extract_all((m for m in mapping.memory_mapping if not _is_other(m)), context),
    )


def _is_other(mapping: am.MemoryMapping) -> bool:
    """Whether something else than data is placed."""
    element = mapping.abstract_element
    return element is not None and not isinstance(element, am.Label | am.Channel) and not element.unresolved


def _extract_tasks(allocations: Iterable[am.TaskAllocation], context: Extracting) -> Iterable[perf.TaskAllocation]:
    for allocation in allocations:
        task = _PROCESS.extract(allocation.task, context, allocation)
        scheduler = _SCHEDULER.extract(allocation.scheduler, context, allocation)
        if task is None or scheduler is None:
            context.note("EXT004", "TaskAllocation ignored: it has no task or no scheduler", allocation)
            continue
        definition = allocation.scheduler.definition if allocation.scheduler is not None else None
        given = extract_parameters(allocation, context, definition.process_parameters if definition is not None else ())
        yield perf.TaskAllocation(
            task=task,
            scheduler=scheduler,
            priority=given.priority,
            deadline=given.deadline,
            cores=_CORES.extract(allocation.affinity, context, allocation),
            parameters=given.parameters,
            origin=context.location(allocation),
        )
