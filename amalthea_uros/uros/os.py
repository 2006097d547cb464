"""The operating system: schedulers, interrupt controllers, resources, and the allocation of processes with their priorities."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from amalthea_uros.perf.activities import SemaphoreAccess
from amalthea_uros.perf.mapping import IsrAllocation, TaskAllocation
from amalthea_uros.perf.os import (
    Duration,
    InterruptController,
    OperatingSystem,
    Os,
    Parameter,
    Policy,
    Scheduler,
    Semaphore,
    SemaphoreKind,
)
from amalthea_uros.uros.assembly.context import AssemblyContext
from amalthea_uros.uros.assembly.rtos import check_priority
from amalthea_uros.uros.assembly.tasks import PlannedIsr, PlannedTask
from amalthea_uros.uros.priorities import priorities


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
