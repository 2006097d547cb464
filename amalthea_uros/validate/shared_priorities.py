"""Tasks that have the same priority where the priority decides."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.os import Policy
from amalthea_uros.timing.allocation import deciding_scheduler, effective_priority
from amalthea_uros.timing.scheduling import ALIASES, BY_PRIORITY
from amalthea_uros.validate.system_context import SystemContext

#: Scheduler, cores and priority.
_Level = tuple[str, frozenset[str], int]


def sharing_a_priority(context: SystemContext) -> Iterator[tuple[TaskAllocation, int, list[str]]]:
    """The allocations of such tasks, with the priority and the other tasks that have it."""
    levels: dict[_Level, dict[str, None]] = {}
    for allocation in context.system.mapping.tasks:
        level = _level(allocation, context)
        if level is not None:
            levels.setdefault(level, {})[allocation.task] = None
    for allocation in context.system.mapping.tasks:
        level = _level(allocation, context)
        others = [task for task in levels.get(level, ()) if task != allocation.task] if level is not None else []
        if level is not None and others:
            yield allocation, level[-1], others


def _level(allocation: TaskAllocation, context: SystemContext) -> _Level | None:
    """Where and with which priority a task is scheduled, if others of the same priority have to wait for it."""
    scheduler = deciding_scheduler(allocation.scheduler, context.system)
    priority = effective_priority(allocation, context.system)
    if scheduler is None or priority is None:
        return None
    policy = ALIASES.get((scheduler.policy or "").lower(), scheduler.policy)
    # Under round robin it is intended that tasks share a priority.
    if policy not in BY_PRIORITY | {Policy.FIXED_PRIORITY_WITH_BUDGETS} or policy == Policy.PRIORITY_BASED_ROUND_ROBIN:
        return None
    return scheduler.name, context.cores.get(allocation.task, frozenset()), priority
