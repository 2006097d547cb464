"""Allocations of processes and schedulers, and groups of schedulers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from amalthea_uros.metamodel import classes as am
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import model_rule
from amalthea_uros.validate.scheduling import GROUPING, parent_of, policy, responsibilities
from amalthea_uros.validate.wording import joined


@model_rule("AM-Mapping-Task-Scheduler", am.Task)
def _check_task(element: am.Task, context: Context) -> Iterator[str]:
    if not context.uses(am.TaskAllocation, "task")[element]:
        yield f"task {element.name!r} has no task allocation"


@model_rule("AM-Mapping-ISR-Scheduler", am.ISR)
def _check_isr(element: am.ISR, context: Context) -> Iterator[str]:
    if not context.uses(am.ISRAllocation, "isr")[element]:
        yield f"ISR {element.name!r} has no ISR allocation"


@model_rule("AM-Mapping-Scheduler-ProcessingUnit", am.Scheduler)
def _check_scheduler(element: am.Scheduler, context: Context) -> Iterator[str]:
    if policy(element) != GROUPING and not context.uses(am.SchedulerAllocation, "scheduler")[element]:
        yield f"scheduler {element.name!r} has no scheduler allocation"


@model_rule("DOC-Task-Affinity-Intersection", am.TaskAllocation)
def _check_task_affinity_intersection(element: am.TaskAllocation, context: Context) -> Iterator[str]:
    task, scheduler = element.task, element.scheduler
    if task is None or scheduler is None or scheduler.unresolved is not None:
        return
    served = responsibilities(context).get(scheduler, [])
    if not served:
        yield f"task {task.qualified_name!r} cannot run: {scheduler.name!r} is responsible for no processing unit"
    elif element.affinity and set(served).isdisjoint(element.affinity):
        yield f"task {task.qualified_name!r} cannot run: {scheduler.name!r} is responsible for no processing unit of its affinity"


@model_rule("DOC-Task-Single-Scheduler", am.TaskAllocation)
def _check_task_single_scheduler(element: am.TaskAllocation, context: Context) -> Iterator[str]:
    task = element.task
    schedulers = context.once(_schedulers).get(task, {}) if task is not None else {}
    if task is not None and len(schedulers) > 1:
        yield f"task {task.qualified_name!r} is allocated to {joined(repr(each.qualified_name) for each in schedulers)}"


def _schedulers(context: Context) -> dict[am.Task, dict[am.TaskScheduler, None]]:
    found: dict[am.Task, dict[am.TaskScheduler, None]] = {}
    for allocation in context.all(am.TaskAllocation):
        if allocation.task is not None and allocation.scheduler is not None:
            found.setdefault(allocation.task, {})[allocation.scheduler] = None
    return found


@model_rule("DOC-Grouping-Parent", am.TaskScheduler)
def _check_grouping_parent(element: am.TaskScheduler, context: Context) -> Iterator[str]:
    algorithm, definition = policy(element), element.definition
    needs_parent = algorithm == GROUPING or (definition is not None and definition.requires_parent_scheduler is True)
    if needs_parent and parent_of(element) is None:
        yield f"{element.name!r} has no parent scheduler, but {algorithm} requires one"
    children = context.once(_children)[element]
    if definition is not None and definition.has_exactly_one_child is True and children != 1:
        yield f"{element.name!r} schedules {children} tasks and schedulers, but {algorithm} requires exactly one"


def _children(context: Context) -> Counter[am.Scheduler | None]:
    tasks = {
        (allocation.task, allocation.scheduler) for allocation in context.all(am.TaskAllocation) if allocation.task is not None
    }
    children: Counter[am.Scheduler | None] = Counter(scheduler for _, scheduler in tasks)
    children.update(parent_of(scheduler) for scheduler in context.all(am.TaskScheduler))
    return children


@model_rule("DOC-PhysicalSection", am.PhysicalSectionMapping)
def _check_physicalsection(element: am.PhysicalSectionMapping, context: Context) -> Iterator[str]:
    memory = element.memory
    if memory is None:
        return
    for section in element.origin:
        for constraint in context.once(_constraints).get(section, []):
            if memory not in constraint.memories:
                where = f"mapped to {memory.qualified_name!r}, which {constraint.name!r} does not allow"
                yield f"section {section.qualified_name!r} is {where}"


def _constraints(context: Context) -> dict[am.Section, list[am.PhysicalSectionConstraint]]:
    found: dict[am.Section, list[am.PhysicalSectionConstraint]] = {}
    for constraint in context.all(am.PhysicalSectionConstraint):
        if constraint.section is not None and constraint.memories:
            found.setdefault(constraint.section, []).append(constraint)
    return found
