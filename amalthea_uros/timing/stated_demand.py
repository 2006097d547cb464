"""Which processes have an execution time in the model: without one, 0 is not a result but a gap."""

from __future__ import annotations

from amalthea_uros.perf.activities import Execute, ExecutionNeed
from amalthea_uros.perf.distributions import Bounds
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.system import System
from amalthea_uros.timing.stretches import executed


def states_execution_time(process: Process, system: System) -> bool:
    """Whether a process, or a runnable that it calls, has ticks or execution needs; 0 ticks are an execution time, too."""
    return any(map(_is_stated, executed(process.activities, system)))


def states_mean(process: Process, system: System) -> bool:
    """Whether the mean of all execution times of a process is stated; the middle between two bounds is none that anybody stated."""
    demands = (each.demand for each in executed(process.activities, system) if isinstance(each, Execute))
    every = (ticks for demand in demands for ticks in (demand.ticks, *dict(demand.by_core_type).values()))
    return not any(isinstance(ticks, Bounds) for ticks in every)


def _is_stated(activity: object) -> bool:
    match activity:
        case Execute(demand=demand):
            return demand.ticks is not None or bool(demand.by_core_type)
        case ExecutionNeed(needs=needs):
            return bool(needs)
    return False
