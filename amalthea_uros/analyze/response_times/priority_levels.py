"""Response times of all preemptive tasks of a processor or a server: priorities one by one, and who shares one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby

from amalthea_uros.analyze.response_times import fixed_priority, in_order, round_robin
from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.supply import FULL, Supply
from amalthea_uros.analyze.response_times.task import Claim, Response, Sharing, Task
from amalthea_uros.units import Time


def response_times(tasks: Sequence[Task], blocking: Sequence[Time] | None = None, supply: Supply = FULL) -> list[Response]:
    """The response times, in the order of the tasks.

    Parameters
    ----------
    blocking : the longest that each task can wait for one of lower priority; None: not at all
    """
    blocking = blocking or [0] * len(tasks)
    order = sorted(range(len(tasks)), key=lambda index: -tasks[index].priority)
    interference = Interference.of_first([tasks[index] for index in order], supply)
    found: dict[int, Response] = {}
    start: Time = 0
    for first, level in _levels(tasks, order):
        higher = interference[first]
        if len(level) == 1:
            (index,) = level
            claim = Claim.BOUND if blocking[index] or supply is not FULL else Claim.EXACT
            found[index], start = fixed_priority.response_time(tasks[index], higher, blocking[index], start, claim)
            continue
        start = 0
        for index in level:
            others = [tasks[other] for other in level if other != index]
            method = round_robin if tasks[index].sharing is Sharing.SLICES else in_order
            found[index] = method.response_time(tasks[index], others, higher, blocking[index])
    return [found[index] for index in range(len(tasks))]


def _levels(tasks: Sequence[Task], order: Sequence[int]) -> Iterator[tuple[int, list[int]]]:
    """Each priority from the highest one down: how many tasks come before it, and those that have it."""
    before = 0
    for _, group in groupby(order, key=lambda index: tasks[index].priority):
        level = list(group)
        yield before, level
        before += len(level)
