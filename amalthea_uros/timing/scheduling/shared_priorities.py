"""Tasks that have the same priority where the priority decides."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.os import Policy
from amalthea_uros.perf.system import System
from amalthea_uros.timing.scheduling.allocation import deciding_scheduler, effective_priority
from amalthea_uros.timing.scheduling.ranks import is_by_priority, standard_policy

#: Scheduler, cores and priority.
_Level = tuple[str, frozenset[str], int]


def sharing_a_priority(system: System, cores: Mapping[str, frozenset[str]]) -> Iterator[tuple[TaskAllocation, int, list[str]]]:
    """The allocations of such tasks, with the priority and the other tasks that have it.

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
        others = [task for task in levels.get(level, ()) if task != allocation.task] if level is not None else []
        if level is not None and others:
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
