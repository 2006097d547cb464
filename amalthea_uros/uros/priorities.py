"""Rate-monotonic priorities: the shorter the period, the higher the priority (Liu and Layland 1973).

Priorities that the author states stand; the others fit in between them. Among tasks of the same period the executor comes first,
then the order of the file.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import count
from math import inf

from amalthea_uros.units import time_text
from amalthea_uros.uros.notes import Notes
from amalthea_uros.uros.tasks import PlannedTask


def priorities(tasks: Sequence[PlannedTask], notes: Notes) -> Mapping[str, int]:
    """The priority of each task of one core; higher numbers are served first."""
    lowest_first = sorted(tasks, key=_rank)[::-1]
    stated = {task.priority: task for task in tasks if task.priority is not None}
    ceilings = _ceilings(lowest_first)
    found: dict[str, int] = {}
    highest = 0
    for task, ceiling in zip(lowest_first, ceilings, strict=True):
        if task.priority is None:
            found[task.name] = next(number for number in count(highest + 1) if number not in stated)
            if ceiling is not None and found[task.name] > ceiling:
                _note_no_room(task, stated[ceiling], notes)
        else:
            found[task.name] = task.priority
        highest = max(highest, found[task.name])
    _note_duplicates(tasks, notes)
    return found


def _rank(task: PlannedTask) -> tuple[float, bool]:
    """Low for high priorities; what is never known to be activated often comes last."""
    return (task.period if task.period is not None else inf, not task.outranks)


def _ceilings(lowest_first: Sequence[PlannedTask]) -> list[int | None]:
    """For each task the lowest priority that is stated for one that shall come before it."""
    found: list[int | None] = []
    ceiling: int | None = None
    for task in reversed(lowest_first):
        found.append(ceiling)
        if task.priority is not None:
            ceiling = task.priority if ceiling is None else min(ceiling, task.priority)
    return found[::-1]


def _note_no_room(task: PlannedTask, above: PlannedTask, notes: Notes) -> None:
    period = f"period {time_text(task.period)}" if task.period else "no known period"
    message = (
        f"the rate-monotonic priority of {task.name!r} ({period}) does not fit below the stated priority {above.priority} "
        f"of {above.name!r}"
    )
    notes.warning("UR105", message, task.origin, "State its priority too, or leave room between the stated ones.")


def _note_duplicates(tasks: Sequence[PlannedTask], notes: Notes) -> None:
    seen: dict[int, PlannedTask] = {}
    for task in tasks:
        if task.priority is None:
            continue
        other = seen.setdefault(task.priority, task)
        if other is not task:
            message = f"{task.name!r} has the same priority {task.priority} as {other.name!r}"
            notes.warning("UR106", message, task.origin, "Tasks of equal priority are served in the order of their activation.")
