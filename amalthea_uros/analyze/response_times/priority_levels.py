"""Response times of all preemptive tasks of a core or a server, one priority level after the other."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import groupby

from amalthea_uros.analyze.response_times import edf, fixed_priority, round_robin
from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.task import FULL, AnalysedTask, Supply
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.timing.scheduling.scheduled import EqualPriority
from amalthea_uros.units import Time

#: The methods for a task among others of its priority, given the tasks of higher priority and the blocking.
METHODS: Mapping[EqualPriority, Callable[[AnalysedTask, Sequence[AnalysedTask], Interference, Time], Response]] = {
    EqualPriority.FIFO: partial(edf.response_time, method=edf.FIFO_METHOD),
    EqualPriority.EDF: edf.response_time,
    EqualPriority.ROUND_ROBIN: round_robin.response_time,
    EqualPriority.UNKNOWN: fixed_priority.in_any_order,
}


def response_times(
    tasks: Sequence[AnalysedTask], blocking: Sequence[Time] | None = None, supply: Supply = FULL
) -> list[Response]:
    """The response times, in the order of the tasks.

    Parameters
    ----------
    blocking : maximum time that each task waits for one of lower priority; None: 0
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
            method = METHODS[tasks[index].equal_priority]
            found[index] = method(tasks[index], others, higher, blocking[index])
    return [found[index] for index in range(len(tasks))]


def _levels(tasks: Sequence[AnalysedTask], order: Sequence[int]) -> Iterator[tuple[int, list[int]]]:
    """Each priority, highest first: number of tasks of higher priority, and the tasks of this one."""
    before = 0
    for _, group in groupby(order, key=lambda index: tasks[index].priority):
        level = list(group)
        yield before, level
        before += len(level)
