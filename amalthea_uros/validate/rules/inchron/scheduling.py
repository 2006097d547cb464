"""Schedulers, their parameters, and allocations."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.metamodel import classes as am
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, changes, model_rule


@model_rule("INC-MAP-SHAREDRUN", am.Runnable)
def _check_sharedrun(element: am.Runnable, context: Context) -> Iterator[str]:
    systems = context.once(_systems).get(element, [])
    if len(systems) > 1:
        yield f"the runnable {element.name or ''!r} is used by the operating systems {systems[0].name!r} and {systems[1].name!r}"


def _systems(context: Context) -> dict[am.Runnable, list[am.OperatingSystem]]:
    """The operating systems whose processes call a runnable, at most two."""
    calls: dict[am.IExecutable, list[am.Runnable]] = {}
    for call in context.all(am.RunnableCall):
        caller = call.enclosing(am.IExecutable)
        if caller is not None and call.runnable is not None:
            calls.setdefault(caller, []).append(call.runnable)
    found: dict[am.Runnable, list[am.OperatingSystem]] = {}
    for system, process in _processes(context):
        pending = [process]
        while pending:
            for called in calls.get(pending.pop(), []):
                systems = found.setdefault(called, [])
                if system not in systems and len(systems) < 2:
                    systems.append(system)
                    pending.append(called)
    return found


def _processes(context: Context) -> Iterator[tuple[am.OperatingSystem, am.IExecutable]]:
    allocations = [(a.scheduler, a.task) for a in context.all(am.TaskAllocation)]
    interrupts = [(a.controller, a.isr) for a in context.all(am.ISRAllocation)]
    for scheduler, process in (*allocations, *interrupts):
        system = scheduler.enclosing(am.OperatingSystem) if scheduler is not None else None
        if system is not None and process is not None:
            yield system, process


@model_rule("INC-MAP-TASK-ONCE", am.Task, am.ISR)
def _check_task_once(element: am.Task | am.ISR, context: Context) -> Iterator[str | Downgraded]:
    times = context.uses(am.TaskAllocation, "task")[element] + context.uses(am.ISRAllocation, "isr")[element]
    if times > 1:
        yield changes(f"{element.name or ''!r} is allocated {times} times")
    elif not times:
        yield f"{element.name or ''!r} is not allocated"


#: The parameters that am2inc reads, by the class of their holder.
_READ = {am.TaskAllocation: ("priority", "deadline"), am.TaskScheduler: ("priority",)}


@model_rule("INC-OS-ALGOPARAM", am.SchedulingParameter)
def _check_unread(element: am.SchedulingParameter, context: Context) -> Iterator[str]:
    holder = type(element.container)
    name = element.key.name if element.key is not None else ""
    if name not in _READ.get(holder, ()) and (name or holder is not am.TaskScheduler):
        yield f"the scheduling parameter {name!r} of the {holder.__name__} is ignored by am2inc"


@model_rule("INC-OS-DEADLINE-TYPE", am.SchedulingParameter)
def _check_deadline(element: am.SchedulingParameter, context: Context) -> Iterator[str]:
    is_deadline = element.key is not None and element.key.name == "deadline"
    if is_deadline and isinstance(element.container, am.TaskAllocation) and not isinstance(element.value, am.Time):
        yield "the value of the parameter 'deadline' is not a Time"


@model_rule("INC-OS-PRIO-TYPE", am.SchedulingParameter)
def _check_priority(element: am.SchedulingParameter, context: Context) -> Iterator[str]:
    is_priority = element.key is not None and element.key.name == "priority"
    is_read = isinstance(element.container, am.TaskAllocation | am.TaskScheduler)
    if is_priority and is_read and not isinstance(element.value, am.IntegerObject):
        yield "the value of the parameter 'priority' is not an IntegerObject"


@model_rule("INC-OS-ALGORITHM", am.TaskScheduler)
def _check_algorithm(element: am.TaskScheduler, context: Context) -> Iterator[str]:
    before = getattr(element, "scheduling_algorithm", None)
    policy = (
        element.definition.name if element.definition is not None else type(before).__name__ if before is not None else None
    )
    if policy not in (None, "FixedPriorityPreemptive"):
        yield f"the policy {policy} of the scheduler {element.name or ''!r} is changed to FixedPriorityPreemptive by am2inc"


@model_rule("INC-OS-OVERHEAD", am.OsOverhead, am.Scheduler)
def _check_overhead(element: am.OsOverhead | am.Scheduler, context: Context) -> Iterator[str]:
    if isinstance(element, am.OsOverhead) and any(isinstance(part, am.Ticks) for part in element.walk()):
        yield f"the overhead {element.name or ''!r} contains Ticks"
    if isinstance(element, am.Scheduler) and element.computation_items:
        yield f"the scheduler {element.name or ''!r} has computation items"
