"""Priorities under which all tasks of a processor meet their deadlines, if there are any.

N. C. Audsley, "On priority assignment in fixed priority scheduling", Information Processing Letters 79, 2001: from the lowest priority
up, any task that meets its deadline there gets it; if none does, there is no such assignment. It is optimal because a response time
depends on which tasks have higher priorities, not on their order.
"""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.analyze.busy_window import Interference
from amalthea_uros.analyze.fixed_priority import response_time
from amalthea_uros.analyze.task import Task
from amalthea_uros.units import Time


def assign(tasks: Sequence[Task], deadlines: Sequence[Time], above: Sequence[Task] = ()) -> list[int] | None:
    """The tasks by their indices, those of the lowest priority first; None if no assignment meets all deadlines.

    Parameters
    ----------
    above : tasks that come before all of them, such as interrupts
    """
    left = sorted(range(len(tasks)), key=lambda index: -deadlines[index])
    order: list[int] = []
    while left:
        # Most often the one with the longest deadline fits, which is deadline-monotonic order.
        fitting = next((index for index in left if _fits(index, left, tasks, deadlines, above)), None)
        if fitting is None:
            return None
        left.remove(fitting)
        order.append(fitting)
    return order


def _fits(index: int, left: Sequence[int], tasks: Sequence[Task], deadlines: Sequence[Time], above: Sequence[Task]) -> bool:
    """Whether a task meets its deadline below all others that are left."""
    higher = [*above, *(tasks[other] for other in left if other != index)]
    worst = response_time(tasks[index], Interference.of(higher))[0].worst
    return worst is not None and worst <= deadlines[index]
