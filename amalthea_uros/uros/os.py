"""One operating system: schedulers, interrupt controllers, resources, and which task is served where with which priority."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from amalthea_uros.perf.mapping import IsrAllocation, TaskAllocation
from amalthea_uros.perf.os import InterruptController, OperatingSystem, Os, Scheduler, Semaphore, SemaphoreKind
from amalthea_uros.perf.software import SemaphoreAccess
from amalthea_uros.uros.priorities import priorities
from amalthea_uros.uros.tasks import PlannedIsr, PlannedTask
from amalthea_uros.uros.work import Work


def os_of(work: Work) -> Os:
    """The operating system, with a scheduler for each core that has tasks, and what dispatches interrupts."""
    middleware = work.description.middleware
    place = middleware.location("policy")
    system = OperatingSystem(
        name="OS",
        schedulers=tuple(
            Scheduler(name=name, policy=middleware.policy, cores=(core,), executing_core=core, origin=place)
            for core, name in _by_core("Scheduler", work, work.tasks).items()
        ),
        interrupt_controllers=tuple(
            InterruptController(name=name, cores=(core,), executing_core=core)
            for core, name in _by_core("Interrupts", work, work.isrs).items()
        ),
    )
    return Os(systems=(system,), semaphores=tuple(_resources(work)))


def _by_core(base: str, work: Work, processes: Sequence[PlannedTask | PlannedIsr]) -> dict[str, str]:
    """A name for each core that has processes; the plain one if only one core has."""
    used = {process.core for process in processes}
    cores = [core for core in work.controller.frequencies if core in used]
    return {core: base if len(cores) == 1 else f"{base}_{core}" for core in cores}


def _resources(work: Work) -> Iterator[Semaphore]:
    origins = {
        activity.semaphore: runnable.origin
        for runnable in work.runnables.values()
        for activity in runnable.activities
        if isinstance(activity, SemaphoreAccess)
    }
    for name, origin in origins.items():
        yield Semaphore(name=name, kind=SemaphoreKind.RESOURCE, ceiling=True, origin=origin)


def task_allocations(work: Work) -> Iterator[TaskAllocation]:
    """Each task on the scheduler of its core, with its priority."""
    schedulers = _by_core("Scheduler", work, work.tasks)
    ranks: dict[str, int] = {}
    for core in schedulers:
        ranks |= priorities([task for task in work.tasks if task.core == core], work.notes)
    for task in work.tasks:
        yield TaskAllocation(task=task.name, scheduler=schedulers[task.core], priority=ranks[task.name], deadline=task.deadline)


def isr_allocations(work: Work) -> Iterator[IsrAllocation]:
    """Each interrupt service routine on the interrupt controller of its core."""
    controllers = _by_core("Interrupts", work, work.isrs)
    for isr in work.isrs:
        yield IsrAllocation(isr=isr.name, controller=controllers[isr.core], priority=isr.priority)
