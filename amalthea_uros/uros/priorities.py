"""Rate-monotonic priorities: the shorter the period, the higher the priority (Liu and Layland 1973).

Priorities that are set in the description are kept, and the others are assigned between them. Among tasks of the same period the
executor has the highest priority; the others follow in the order of the file.

In a system, a higher number is a higher priority; in descriptions for an operating system such as Zephyr it is the other way round.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import count
from math import inf

from amalthea_uros.perf.system import System
from amalthea_uros.timing.scheduling.allocation import allocated_cores
from amalthea_uros.timing.scheduling.shared_priorities import sharing_a_priority
from amalthea_uros.units import time_text
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.assembly.rtos import HIGHER_IS_MORE_URGENT, PriorityScale
from amalthea_uros.uros.assembly.tasks import PlannedTask


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
    return assigned


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
