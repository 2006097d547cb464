"""Schedulers: their algorithms, those above them, and what they decide for."""

from __future__ import annotations

from amalthea_uros.metamodel.classes import ProcessingUnit, Scheduler, SchedulerAllocation, TaskScheduler
from amalthea_uros.validate.context import Context

#: The algorithm that takes no decisions.
GROUPING = "Grouping"


def algorithm_of(scheduler: Scheduler) -> str | None:
    """The name of its algorithm: a definition since 2.0.0, an object of its own class before."""
    if scheduler.definition is not None:
        return scheduler.definition.name
    before = getattr(scheduler, "scheduling_algorithm", None)
    return None if before is None else type(before).__name__


def parent_of(scheduler: TaskScheduler) -> TaskScheduler | None:
    """The scheduler above."""
    return scheduler.parent_association.parent if scheduler.parent_association is not None else None


def responsibilities(context: Context) -> dict[Scheduler, list[ProcessingUnit]]:
    """The processing units of each scheduler: its own, or else those of the next scheduler above that has some."""
    found: dict[Scheduler, list[ProcessingUnit]] = {}
    for allocation in context.all(SchedulerAllocation):
        if allocation.scheduler is not None and allocation.responsibility:
            found.setdefault(allocation.scheduler, []).extend(allocation.responsibility)
    for scheduler in context.all(TaskScheduler):
        without: list[TaskScheduler] = []
        above: TaskScheduler | None = scheduler
        while above is not None and above not in found:
            found[above] = []  # ends a circle
            without.append(above)
            above = parent_of(above)
        for each in without:
            found[each] = [] if above is None else found[above]
    return found
