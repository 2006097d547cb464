"""The overhead of the operating system: functions that jobs execute before and after what they do themselves.

AMALTHEA charges calls of services and the entry of interrupts (`OsOverhead`), but no dispatching of a task that a stimulus activates.
Functions of the job have the same meaning in every tool.
"""

from __future__ import annotations

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.activities import Activity, Call
from amalthea_uros.perf.software import IsrCategory, Runnable
from amalthea_uros.spec.os import OverheadSection, OverheadTime
from amalthea_uros.uros.assembly.context import AssemblyContext
from amalthea_uros.uros.assembly.planned import PlannedIsr, PlannedTask


@dataclass(frozen=True, slots=True)
class _OverheadTimes:
    """What precedes and follows a job; None: nothing."""

    activation: OverheadTime | None
    termination: OverheadTime | None

    def overridden(self, own: OverheadSection | None) -> _OverheadTimes:
        """The same with the times that a process states itself."""
        if own is None:
            return self
        return _OverheadTimes(own.activation or self.activation, own.termination or self.termination)


def add_overheads(context: AssemblyContext) -> None:
    """Add the overhead of each process that has been planned."""
    stated = context.description.os.overhead
    of_tasks = _OverheadTimes(stated.activation, stated.termination)
    of_isrs = _OverheadTimes(stated.isr.activation, stated.isr.termination)
    for index, isr in enumerate(context.isrs):
        activities = _activities(isr, of_isrs.overridden(isr.overhead), context)
        context.isrs[index] = replace(isr, activities=activities)
    highest = max((isr.priority for isr in context.isrs), default=0)
    for index, task in enumerate(context.tasks):
        times = of_tasks.overridden(task.overhead)
        if stated.activations_run_in == "interrupt":
            # The order of the interrupts has no effect on tasks; with different priorities it is known.
            _add_interrupt(task, times.activation, highest + len(context.tasks) - index, context)
            times = replace(times, activation=None)
        context.tasks[index] = replace(task, activities=_activities(task, times, context))


def _activities(process: PlannedTask | PlannedIsr, times: _OverheadTimes, context: AssemblyContext) -> tuple[Activity, ...]:
    """The activities of a process with its overhead."""
    before = _calls(_activation_name(process.name), times.activation, process.core, process.origin, context)
    after = _calls(f"{process.name}_Termination", times.termination, process.core, process.origin, context)
    return (*before, *process.activities, *after)


def _add_interrupt(task: PlannedTask, time: OverheadTime | None, priority: int, context: AssemblyContext) -> None:
    """Add the interrupt that activates a task."""
    name = _activation_name(task.name)
    calls = _calls(name, time, task.core, task.origin, context)
    if not calls:
        return
    processes: tuple[PlannedTask | PlannedIsr, ...] = (*context.tasks, *context.isrs)
    if any(process.name == name for process in processes):
        context.notes.error(
            "APP002", f"{name!r} is the interrupt that activates {task.name!r}", task.origin, "Rename the other one."
        )
    context.isrs.append(
        PlannedIsr(
            name=name,
            core=task.core,
            stimuli=task.stimuli,
            activities=calls,
            priority=priority,
            category=IsrCategory.CATEGORY_1,
            origin=task.origin,
        )
    )


def _calls(
    name: str, time: OverheadTime | None, core: str, origin: Location | None, context: AssemblyContext
) -> tuple[Call, ...]:
    """The call of a new function that takes a time; nothing if it takes none."""
    activities = context.converter.execute([time], core, time.location() if time else origin)
    if not activities:
        return ()
    if name in context.runnables:
        message = f"runnable {name!r} has the name of an overhead of the operating system"
        context.notes.error("APP002", message, context.runnables[name].origin or origin, "Rename it.")
    context.runnables[name] = Runnable(name=name, activities=activities, is_overhead=True, origin=origin)
    return (Call(runnable=name),)


def _activation_name(process: str) -> str:
    return f"{process}_Activation"
