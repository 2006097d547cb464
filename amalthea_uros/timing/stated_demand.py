"""Which processes have an execution time in the model: without one, 0 is not a result but a gap."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros._internal.graphs import bottom_up
from amalthea_uros.perf.software import Call, Execute, ExecutionNeed, Process, Runnable, walk
from amalthea_uros.perf.system import System


def states_execution_time(process: Process, system: System) -> bool:
    """Whether a process, or a runnable that it calls, has ticks or execution needs; 0 ticks are an execution time, too."""
    called = bottom_up(_called(process), lambda name: _called(system.runnables.get(name)))
    holders = [process, *(system.runnables[name] for name in called if name in system.runnables)]
    return any(_is_stated(activity) for holder in holders for activity in walk(holder.activities))


def _called(holder: Process | Runnable | None) -> Iterator[str]:
    activities = walk(holder.activities) if holder is not None else ()
    return (activity.runnable for activity in activities if isinstance(activity, Call))


def _is_stated(activity: object) -> bool:
    match activity:
        case Execute(demand=demand):
            return demand.ticks is not None or bool(demand.by_core_type)
        case ExecutionNeed(needs=needs):
            return bool(needs)
    return False
