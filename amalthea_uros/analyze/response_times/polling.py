"""What loops without a sleep execute besides their rounds for messages and timers.

- Before each expiration of a timer they look for messages again and again, for less than the resolution of the wait.
- When nothing happens, a round follows each wait that ends by its timeout.

Both count as tasks of their own with the rank of the executor.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from amalthea_uros.analyze.response_times.task import Task
from amalthea_uros.analyze.solution import Solution
from amalthea_uros.perf.executors import Executor
from amalthea_uros.timing.event_models import Periodic
from amalthea_uros.timing.executors.loops import polling_time
from amalthea_uros.timing.executors.wait import timeout_of, timers
from amalthea_uros.timing.multiframe import MultiframeDemand
from amalthea_uros.timing.scheduling import ScheduledProcess


def polling_tasks(items: Iterable[ScheduledProcess], solution: Solution, priority: int = 0) -> list[Task]:
    """The polling of the executors among some processes of a core."""
    executors = solution.context.system.executor_of_task
    return [
        task
        for item in items
        if item.name in executors
        for task in _of(executors[item.name], item, solution, priority)
    ]


def _of(executor: Executor, item: ScheduledProcess, solution: Solution, priority: int) -> Iterator[Task]:
    polling, time_base = polling_time(executor), solution.context.time_base(item.name)
    if not polling:
        return
    for timer in timers(executor):
        if timer.interval:
            yield Task(
                name=f"polling before {timer.name}",
                events=Periodic(timer.interval * time_base),
                demand=MultiframeDemand.constant(polling * time_base, best=0),
                priority=priority,
                equal_priority=item.equal_priority,
            )
    timeout = timeout_of(executor)
    if timeout:
        demand = solution.context.demands[item.name]
        yield Task(
            name=f"timeouts of {executor.name}",
            events=Periodic(timeout * time_base),
            demand=MultiframeDemand.constant(demand.best, best=0),
            priority=priority,
            equal_priority=item.equal_priority,
        )
