"""Deadlines of callbacks that run in executors with loops: the task of the rounds has none for each of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from amalthea_uros.perf.constraints import Requirement, TimeLimit, TimeMetric
from amalthea_uros.perf.executors import Executor
from amalthea_uros.uros.callbacks import Callback


def deadlines(executors: Iterable[Executor], callbacks: Sequence[Callback]) -> Iterator[Requirement]:
    """The deadlines of callbacks as requirements on the response times of their runnables."""
    runnables = {handle.name: handle.runnable for executor in executors for handle in executor.handles}
    for callback in callbacks:
        deadline = callback.section.deadline
        if callback.in_executor and callback.name in runnables and deadline is not None:
            yield Requirement(
                name=f"{callback.name}_deadline",
                runnable=runnables[callback.name],
                limit=TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=deadline),
                origin=callback.section.location("deadline"),
            )
