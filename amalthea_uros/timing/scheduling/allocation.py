"""Possible cores, deciding schedulers, priorities and clocks of processes, also in systems that cannot be analysed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import takewhile

from amalthea_uros.perf.hardware import StructureKind
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.os import Policy, Scheduler
from amalthea_uros.perf.system import System
from amalthea_uros.units import Frequency


def allocated_cores(system: System) -> Mapping[str, frozenset[str]]:
    """The cores on which each process can run; processes without a core are left out."""
    found: dict[str, set[str]] = {}
    for task in system.mapping.tasks:
        served = scheduler_cores(task.scheduler, system)
        found.setdefault(task.task, set()).update(core for core in served if not task.cores or core in task.cores)
    for isr in system.mapping.isrs:
        controller = system.interrupt_controllers.get(isr.controller)
        found.setdefault(isr.isr, set()).update(controller.cores if controller is not None else ())
    return {process: frozenset(cores) for process, cores in found.items() if cores}


def scheduler_cores(scheduler: str, system: System) -> tuple[str, ...]:
    """The cores of a scheduler: its own, or those of the nearest scheduler above that has cores."""
    return next((each.cores for each in upwards(scheduler, system) if each.cores), ())


def upwards(scheduler: str, system: System) -> Iterator[Scheduler]:
    """A scheduler and those above it."""
    seen: set[str] = set()
    name: str | None = scheduler
    while name is not None and name not in seen and name in system.schedulers:
        seen.add(name)
        found = system.schedulers[name]
        yield found
        name = found.parent.scheduler if found.parent is not None else None


def deciding_scheduler(scheduler: str, system: System) -> Scheduler | None:
    """The scheduler that decides for the tasks of a scheduler: a grouping delegates to its parent."""
    return next((each for each in upwards(scheduler, system) if each.policy != Policy.GROUPING), None)


def effective_priority(allocation: TaskAllocation, system: System) -> int | None:
    """The priority of a task, or of its group; None if there is none."""
    if allocation.priority is not None:
        return allocation.priority
    groups = takewhile(lambda each: each.policy == Policy.GROUPING, upwards(allocation.scheduler, system))
    return next((each.parent.priority for each in groups if each.parent and each.parent.priority is not None), None)


def operating_system_of(system: System) -> Mapping[str, str]:
    """The operating system of each scheduler and interrupt controller."""
    return {
        scheduler.name: operating_system.name
        for operating_system in system.os.systems
        for scheduler in (*operating_system.schedulers, *operating_system.interrupt_controllers)
    }


def frequency_of(clock: str | None, system: System) -> Frequency | None:
    """The frequency of a clock; None if it is unknown, and what a frequency that is not positive stands for is unknown, too."""
    found = system.clocks.get(clock or "")
    return found.frequency if found is not None and found.frequency is not None and found.frequency > 0 else None


def controller_of_core(system: System) -> dict[str, str]:
    """The controller of each core; cores of different controllers do not share a clock."""
    found: dict[str, str] = {}
    for structure in system.hardware.walk():
        if structure.kind is StructureKind.ECU:
            for inner in structure.walk():
                found.update(dict.fromkeys((core.name for core in inner.cores), structure.name))
    return found
