"""Schedulers, their parameters, and allocations."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.metamodel.classes import (
    ISR,
    IExecutable,
    IntegerObject,
    ISRAllocation,
    OperatingSystem,
    OsOverhead,
    Runnable,
    RunnableCall,
    Scheduler,
    SchedulingParameter,
    Task,
    TaskAllocation,
    TaskScheduler,
    Ticks,
    Time,
)
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, changes, model_rule


@model_rule("INC-MAP-SHAREDRUN", Runnable)
def _check_sharedrun(element: Runnable, context: Context) -> Iterator[str]:
    systems = context.once(_systems).get(element, [])
    if len(systems) > 1:
        yield f"the runnable {element.name or ''!r} is used by the operating systems {systems[0].name!r} and {systems[1].name!r}"


def _systems(context: Context) -> dict[Runnable, list[OperatingSystem]]:
    """The operating systems whose processes call a runnable, at most two."""
    calls: dict[IExecutable, list[Runnable]] = {}
    for call in context.all(RunnableCall):
        caller = call.enclosing(IExecutable)
        if caller is not None and call.runnable is not None:
            calls.setdefault(caller, []).append(call.runnable)
    found: dict[Runnable, list[OperatingSystem]] = {}
    for system, process in _processes(context):
        pending = [process]
        while pending:
            for called in calls.get(pending.pop(), []):
                systems = found.setdefault(called, [])
                if system not in systems and len(systems) < 2:
                    systems.append(system)
                    pending.append(called)
    return found


def _processes(context: Context) -> Iterator[tuple[OperatingSystem, IExecutable]]:
    allocations = [(a.scheduler, a.task) for a in context.all(TaskAllocation)]
    interrupts = [(a.controller, a.isr) for a in context.all(ISRAllocation)]
    for scheduler, process in (*allocations, *interrupts):
        system = scheduler.enclosing(OperatingSystem) if scheduler is not None else None
        if system is not None and process is not None:
            yield system, process


@model_rule("INC-MAP-TASK-ONCE", Task, ISR)
def _check_task_once(element: Task | ISR, context: Context) -> Iterator[str | Downgraded]:
    times = context.uses(TaskAllocation, "task")[element] + context.uses(ISRAllocation, "isr")[element]
    if times > 1:
        yield changes(f"{element.name or ''!r} is allocated {times} times")
    elif not times:
        yield f"{element.name or ''!r} is not allocated"


#: The parameters that am2inc reads, by the class of their holder.
_READ = {TaskAllocation: ("priority", "deadline"), TaskScheduler: ("priority",)}


@model_rule("INC-OS-ALGOPARAM", SchedulingParameter)
def _check_unread(element: SchedulingParameter, context: Context) -> Iterator[str]:
    holder = type(element.container)
    name = element.key.name if element.key is not None else ""
    if name not in _READ.get(holder, ()) and (name or holder is not TaskScheduler):
        yield f"the scheduling parameter {name!r} of the {holder.__name__} is ignored by am2inc"


@model_rule("INC-OS-DEADLINE-TYPE", SchedulingParameter)
def _check_deadline(element: SchedulingParameter, context: Context) -> Iterator[str]:
    is_deadline = element.key is not None and element.key.name == "deadline"
    if is_deadline and isinstance(element.container, TaskAllocation) and not isinstance(element.value, Time):
        yield "the value of the parameter 'deadline' is not a Time"


@model_rule("INC-OS-PRIO-TYPE", SchedulingParameter)
def _check_priority(element: SchedulingParameter, context: Context) -> Iterator[str]:
    is_priority = element.key is not None and element.key.name == "priority"
    is_read = isinstance(element.container, TaskAllocation | TaskScheduler)
    if is_priority and is_read and not isinstance(element.value, IntegerObject):
        yield "the value of the parameter 'priority' is not an IntegerObject"


@model_rule("INC-OS-ALGORITHM", TaskScheduler)
def _check_algorithm(element: TaskScheduler, context: Context) -> Iterator[str]:
    before = getattr(element, "scheduling_algorithm", None)
    policy = (
        element.definition.name if element.definition is not None else type(before).__name__ if before is not None else None
    )
    if policy not in (None, "FixedPriorityPreemptive"):
        yield f"the policy {policy} of the scheduler {element.name or ''!r} is changed to FixedPriorityPreemptive by am2inc"


@model_rule("INC-OS-OVERHEAD", OsOverhead, Scheduler)
def _check_overhead(element: OsOverhead | Scheduler, context: Context) -> Iterator[str]:
    if isinstance(element, OsOverhead) and any(isinstance(part, Ticks) for part in element.walk()):
        yield f"the overhead {element.name or ''!r} contains Ticks"
    if isinstance(element, Scheduler) and element.computation_items:
        yield f"the scheduler {element.name or ''!r} has computation items"
