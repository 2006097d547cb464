"""Overheads of the operating system: services add to the demand of their callers, interrupt entry and exit to that of the ISR.

Runnables can be overhead, too, of the process that calls them.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.activities import (
    AccessKind,
    Activity,
    Call,
    ClearEvent,
    Demand,
    Group,
    SchedulePoint,
    SemaphoreAccess,
    SemaphoreOperation,
    SenderReceiverAccess,
    ServerCall,
    ServerCallKind,
    SetEvent,
    Terminate,
    Trigger,
    WaitEvent,
)
from amalthea_uros.perf.os import Overhead, SemaphoreKind, Service
from amalthea_uros.perf.software import Isr, IsrCategory
from amalthea_uros.perf.system import System

_OF_ACTIVITIES: dict[type, tuple[Service, ...]] = {
    Trigger: (Service.ACTIVATE_TASK,),
    Terminate: (Service.TERMINATE_TASK,),
    SchedulePoint: (Service.SCHEDULE,),
    SetEvent: (Service.SET_EVENT,),
    WaitEvent: (Service.WAIT_EVENT,),
    ClearEvent: (Service.CLEAR_EVENT,),
}
_OF_ACCESSES = {AccessKind.READ: Service.SENDER_RECEIVER_READ, AccessKind.WRITE: Service.SENDER_RECEIVER_WRITE}
_OF_SEMAPHORES = {
    (True, True): Service.RELEASE_SPINLOCK,
    (True, False): Service.REQUEST_SPINLOCK,
    (False, True): Service.RELEASE_RESOURCE,
    (False, False): Service.REQUEST_RESOURCE,
}
#: Services whose calls are known.
COUNTED = {
    *(service for services in _OF_ACTIVITIES.values() for service in services),
    *_OF_SEMAPHORES.values(),
    *_OF_ACCESSES.values(),
    Service.SERVER_CALL,
    Service.SUSPEND_INTERRUPTS,
    Service.RESUME_INTERRUPTS,
}


#: Of the runnables that are overhead.
ASSUMPTION = (
    "the overhead of the operating system that is part of a task is executed at the priority of that task: "
    "it delays no task of higher priority"
)


def has_overhead_of_tasks(system: System) -> bool:
    """Whether tasks execute work of the operating system."""
    return not processes_with_overhead(system).isdisjoint(task.name for task in system.software.tasks)


def processes_with_overhead(system: System) -> frozenset[str]:
    """The processes that execute work of the operating system, which is part of their execution times."""
    overheads = {runnable.name for runnable in system.software.runnables if runnable.is_overhead}

    def is_overhead(activity: Activity) -> bool:
        return isinstance(activity, Call) and activity.runnable in overheads

    return frozenset(name for name, process in system.processes.items() if any(map(is_overhead, process.activities)))


@dataclass(frozen=True)
class Overheads:
    """The overheads of the operating systems of a system."""

    system: System

    @cached_property
    def _by_core(self) -> dict[str, tuple[Overhead, dict[Service, Demand]]]:
        stated = {overhead.name: overhead for overhead in self.system.os.overheads}
        found = {}
        for operating_system in self.system.os.systems:
            overhead = stated.get(operating_system.overhead or "")
            if overhead is not None:
                cores = (core for scheduler in operating_system.schedulers for core in scheduler.cores)
                found.update(dict.fromkeys(cores, (overhead, dict(overhead.services))))
        return found

    @cached_property
    def _kinds(self) -> dict[str, SemaphoreKind | None]:
        return {semaphore.name: semaphore.kind for semaphore in self.system.os.semaphores}

    def of_activity(self, activity: Activity, core: str) -> Iterator[Demand]:
        """The demands of the services that an activity calls."""
        if core in self._by_core:
            _, demands = self._by_core[core]
            yield from (demands[service] for service in self._services(activity) if service in demands)

    def _services(self, activity: Activity) -> tuple[Service, ...]:
        match activity:
            case SemaphoreAccess(semaphore=name, operation=operation):
                is_release = operation is SemaphoreOperation.RELEASE
                return (_OF_SEMAPHORES[self._kinds.get(name) is SemaphoreKind.SPINLOCK, is_release],)
            case SenderReceiverAccess(kind=kind):
                return (_OF_ACCESSES[kind],)
            case ServerCall(kind=ServerCallKind.SYNCHRONOUS):
                return (Service.SERVER_CALL,)
            case Group(interruptible=False):
                return (Service.SUSPEND_INTERRUPTS, Service.RESUME_INTERRUPTS)
        return _OF_ACTIVITIES.get(type(activity), ())

    def of_isr(self, isr: Isr, core: str) -> tuple[Demand | None, Demand | None]:
        """The demands of entry and exit of an interrupt service routine, if they are stated."""
        if core not in self._by_core:
            return (None, None)
        overhead, _ = self._by_core[core]
        around = overhead.category_1 if isr.category is IsrCategory.CATEGORY_1 else overhead.category_2
        return (None, None) if around is None else (around.before, around.after)
