"""Possible cores, deciding schedulers, policies, priorities and clocks of processes, also in systems that cannot be analysed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from itertools import takewhile

from amalthea_uros.perf.hardware import StructureKind
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.os import Parent, Policy, Scheduler
from amalthea_uros.perf.system import System
from amalthea_uros.units import Time

#: Policies that serve the highest priority first, as far as there is an analysis for them.
BY_PRIORITY = {Policy.FIXED_PRIORITY_PREEMPTIVE, Policy.OSEK, Policy.PRIORITY_BASED_ROUND_ROBIN}
#: Other names of policies, in lower case; since AMALTHEA 2.0 only the name identifies a policy.
_ALIASES = {
    **{policy.lower(): policy for policy in Policy},
    "fpp": Policy.FIXED_PRIORITY_PREEMPTIVE,
    "fixed priority preemptive": Policy.FIXED_PRIORITY_PREEMPTIVE,
    "autosar": Policy.OSEK,
    "edf": Policy.EARLIEST_DEADLINE_FIRST,
    "deadline monotonic": Policy.DEADLINE_MONOTONIC,
    "rate monotonic": Policy.RATE_MONOTONIC,
}
#: Scheduler, cores and priority.
_Level = tuple[str, frozenset[str], int]


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


def effective_priority(allocation: TaskAllocation | Parent, system: System) -> int | None:
    """The priority of a task or scheduler, or of its group; None if there is none."""
    return _effective(allocation, system, lambda stated: stated.priority)


def effective_deadline(allocation: TaskAllocation, system: System) -> Time | None:
    """The deadline that the allocation of a task states, or that of its group; None if there is none."""
    return _effective(allocation, system, lambda stated: stated.deadline)


def _effective(
    allocation: TaskAllocation | Parent, system: System, value: Callable[[TaskAllocation | Parent], int | None]
) -> int | None:
    """A parameter of a task, or of the nearest group that has it."""
    groups = takewhile(lambda each: each.policy == Policy.GROUPING, upwards(allocation.scheduler, system))
    stated: list[TaskAllocation | Parent] = [allocation, *(each.parent for each in groups if each.parent is not None)]
    return next((number for each in stated if (number := value(each)) is not None), None)


def operating_system_of(system: System) -> Mapping[str, str]:
    """The operating system of each scheduler and interrupt controller."""
    return {
        scheduler.name: operating_system.name
        for operating_system in system.os.systems
        for scheduler in (*operating_system.schedulers, *operating_system.interrupt_controllers)
    }


def controller_of_core(system: System) -> dict[str, str]:
    """The controller of each core; cores of different controllers do not share a clock."""
    found: dict[str, str] = {}
    for structure in system.hardware.walk():
        if structure.kind is StructureKind.ECU:
            for inner in structure.walk():
                found.update(dict.fromkeys((core.name for core in inner.cores), structure.name))
    return found


def standard_policy(name: str | None) -> str | None:
    """The standard name of a policy; that of the model if it is none of these."""
    return _ALIASES.get((name or "").lower(), name)


def is_without_meaning(policy: str | None) -> bool:
    """Whether the name of a policy says nothing; migrated ones have a number."""
    return policy is not None and policy.startswith("UserSpecificSchedulingAlgorithm")


def is_by_priority(name: str | None) -> bool:
    """Whether a policy serves the highest priority first."""
    return standard_policy(name) in BY_PRIORITY | {Policy.FIXED_PRIORITY_WITH_BUDGETS}


def sharing_a_priority(system: System, cores: Mapping[str, frozenset[str]]) -> Iterator[tuple[TaskAllocation, int, list[str]]]:
    """The allocations of tasks that share a priority where the priority decides, with the priority and the other tasks that have it.

    Executors that spin in one thread have its priority, and share it with nobody.

    Parameters
    ----------
    cores : those on which each process may run
    """
    levels: dict[_Level, dict[str, None]] = {}
    for allocation in system.mapping.tasks:
        level = _level(allocation, system, cores)
        if level is not None:
            levels.setdefault(level, {})[allocation.task] = None
    for allocation in system.mapping.tasks:
        level = _level(allocation, system, cores)
        if level is None:
            continue
        own = system.tasks_of_thread(allocation.task)
        others = [task for task in levels[level] if task not in own]
        if others:
            yield allocation, level[-1], others


def _level(allocation: TaskAllocation, system: System, cores: Mapping[str, frozenset[str]]) -> _Level | None:
    """Where and with which priority a task is scheduled, if others of the same priority have to wait for it."""
    scheduler = deciding_scheduler(allocation.scheduler, system)
    priority = effective_priority(allocation, system)
    if scheduler is None or priority is None:
        return None
    # Messages on a wire that have no identifiers are meant to be sent in the order in which they were queued.
    if allocation.task in system.transmissions:
        return None
    # Under round robin it is intended that tasks share a priority.
    if not is_by_priority(scheduler.policy) or standard_policy(scheduler.policy) == Policy.PRIORITY_BASED_ROUND_ROBIN:
        return None
    return scheduler.name, cores.get(allocation.task, frozenset()), priority
