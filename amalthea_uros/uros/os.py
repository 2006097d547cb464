"""The operating system: schedulers, interrupt controllers, resources, and the allocation of processes with their priorities.

Priorities are rate-monotonic: the shorter the period, the higher the priority (Liu and Layland 1973). Those that are set in the
description are kept, and the others are assigned between them. Among tasks of the same period the executor has the highest priority;
the others follow in the order of the file. In a system, a higher number is a higher priority; in descriptions for an operating system
such as Zephyr it is the other way round.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import count
from math import inf

from amalthea_uros.perf.activities import SemaphoreAccess
from amalthea_uros.perf.mapping import IsrAllocation, TaskAllocation
from amalthea_uros.perf.os import (
    InterruptController,
    OperatingSystem,
    Os,
    Parameter,
    Policy,
    Scheduler,
    Semaphore,
    SemaphoreKind,
)
from amalthea_uros.perf.system import System
from amalthea_uros.spec.os import OsSection
from amalthea_uros.timing.scheduling.allocation import allocated_cores, sharing_a_priority
from amalthea_uros.units import Duration, time_text
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.assembly.context import AssemblyContext
from amalthea_uros.uros.assembly.planned import HIGHER_IS_MORE_URGENT, PlannedIsr, PlannedTask, PriorityScale


def os_of(context: AssemblyContext) -> Os:
    """The operating system, with a scheduler for each core that has tasks, and an interrupt controller for each that has ISRs."""
    system = OperatingSystem(
        name="OS",
        schedulers=tuple(
            _scheduler(name, core, context) for core, name in _by_core("Scheduler", context, context.tasks).items()
        ),
        interrupt_controllers=tuple(
            InterruptController(name=name, cores=(core,), executing_core=core)
            for core, name in _by_core("Interrupts", context, context.isrs).items()
        ),
    )
    return Os(systems=(system,), semaphores=tuple(_resources(context)))


def _scheduler(name: str, core: str, context: AssemblyContext) -> Scheduler:
    """The scheduler of a core; where tasks share a priority and the operating system lets these take turns, with time slices."""
    middleware, slice_ = context.description.middleware, context.description.os.time_slice
    stated = [task.priority for task in context.tasks if task.core == core and task.priority is not None]
    takes_turns = bool(slice_) and middleware.policy != "OSEK" and len(set(stated)) < len(stated)
    return Scheduler(
        name=name,
        policy=Policy.PRIORITY_BASED_ROUND_ROBIN if takes_turns else middleware.policy,
        cores=(core,),
        executing_core=core,
        parameters=(Parameter("timeSliceLength", (Duration(slice_),)),) if slice_ and takes_turns else (),
        origin=middleware.location("policy"),
    )


def _by_core(base: str, context: AssemblyContext, processes: Sequence[PlannedTask | PlannedIsr]) -> dict[str, str]:
    """A name for each core that has processes; without the core if there is only one."""
    used = {process.core for process in processes}
    cores = [core for core in context.controller.frequencies if core in used]
    return {core: base if len(cores) == 1 else f"{base}_{core}" for core in cores}


def _resources(context: AssemblyContext) -> Iterator[Semaphore]:
    origins = {
        activity.semaphore: runnable.origin
        for runnable in context.runnables.values()
        for activity in runnable.activities
        if isinstance(activity, SemaphoreAccess)
    }
    for name, origin in origins.items():
        yield Semaphore(name=name, kind=SemaphoreKind.RESOURCE, ceiling=True, origin=origin)


def task_allocations(context: AssemblyContext) -> Iterator[TaskAllocation]:
    """Each task on the scheduler of its core, with its priority."""
    schedulers = _by_core("Scheduler", context, context.tasks)
    os, scale = context.description.os, context.priority_scale
    ranks: dict[str, int] = {}
    for core in schedulers:
        ranks |= priorities([task for task in context.tasks if task.core == core], context.notes, scale)
    for task in context.tasks:
        check_priority(task, scale.number(ranks[task.name]), os, context.notes)
        yield TaskAllocation(task=task.name, scheduler=schedulers[task.core], priority=ranks[task.name], deadline=task.deadline)


def isr_allocations(context: AssemblyContext) -> Iterator[IsrAllocation]:
    """Each interrupt service routine on the interrupt controller of its core."""
    controllers = _by_core("Interrupts", context, context.isrs)
    for isr in context.isrs:
        yield IsrAllocation(isr=isr.name, controller=controllers[isr.core], priority=isr.priority)


def priorities(tasks: Sequence[PlannedTask], notes: Notes, scale: PriorityScale = HIGHER_IS_MORE_URGENT) -> Mapping[str, int]:
    """The priority of each task of one core; a higher number is a higher priority.

    Parameters
    ----------
    scale : what the priorities of the tasks mean
    """
    lowest_first = sorted(tasks, key=_rate_monotonic)[::-1]
    preset = {scale.rank(task.priority): task for task in tasks if task.priority is not None}
    assigned: dict[str, int] = {}
    highest = 0
    for task, limit in zip(lowest_first, _upper_limits(lowest_first, scale), strict=True):
        if task.priority is None:
            assigned[task.name] = next(number for number in count(highest + 1) if number not in preset)
            if limit is not None and assigned[task.name] > limit:
                _report_no_gap(task, preset[limit], notes)
        else:
            assigned[task.name] = scale.rank(task.priority)
        highest = max(highest, assigned[task.name])
    return assigned | _of_threads(tasks, assigned)


def _of_threads(tasks: Sequence[PlannedTask], assigned: Mapping[str, int]) -> dict[str, int]:
    """The priority of the tasks that are parts of a thread: the highest one."""
    return {
        task.name: max(assigned[each.name] for each in tasks if each.thread == task.thread) for task in tasks if task.thread
    }


def _rate_monotonic(task: PlannedTask) -> tuple[float, bool]:
    """A key that sorts tasks by falling priority; a task of unknown period comes last."""
    return (task.period if task.period is not None else inf, not task.wins_ties)


def _upper_limits(lowest_first: Sequence[PlannedTask], scale: PriorityScale) -> list[int | None]:
    """For each task the lowest preset priority among the tasks that should have a higher priority."""
    limits: list[int | None] = []
    limit: int | None = None
    for task in reversed(lowest_first):
        limits.append(limit)
        if task.priority is not None:
            rank = scale.rank(task.priority)
            limit = rank if limit is None else min(limit, rank)
    return limits[::-1]


def _report_no_gap(task: PlannedTask, above: PlannedTask, notes: Notes) -> None:
    period = f"period {time_text(task.period)}" if task.period else "unknown period"
    message = (
        f"no priority is left for {task.name!r} ({period}) below {above.name!r}, whose priority is set to {above.priority}; "
        "rate-monotonic order is violated"
    )
    notes.warning("UR105", message, task.origin, f"Set the priority of {task.name!r}, or raise that of {above.name!r}.")


def check_shared_priorities(
    system: System, tasks: Iterable[PlannedTask], notes: Notes, scale: PriorityScale = HIGHER_IS_MORE_URGENT
) -> None:
    """Report the tasks that have the priority of one before them, where the priority decides."""
    origins = {task.name: task.origin for task in tasks}
    seen: set[str] = set()
    for allocation, priority, others in sharing_a_priority(system, allocated_cores(system)):
        seen.add(allocation.task)
        before = next((other for other in others if other in seen), None)
        if before is not None:
            message = f"{allocation.task!r} has the same priority {scale.number(priority)} as {before!r}"
            notes.warning("UR106", message, origins.get(allocation.task), "Set different priorities.")


def check_priority(task: PlannedTask, number: int, os: OsSection, notes: Notes) -> None:
    """Report a priority that the operating system does not have."""
    allowed = os.priority_range
    if allowed is None or allowed.lowest <= number <= allowed.highest:
        return
    limits = f"outside {allowed.lowest} to {allowed.highest}, the range of {os.title}"
    if task.priority is None:
        message = f"{task.name!r} gets priority {number}, which is {limits}"
        advice = "Set the priorities of the tasks, and give the same one to tasks that may wait for each other."
    else:
        message = f"the priority {number} of {task.name!r} is {limits}"
        advice = f"Set a priority from {allowed.lowest} to {allowed.highest}, or 'priority_range' under 'os'."
    notes.warning("UR160", message, task.origin, advice)
