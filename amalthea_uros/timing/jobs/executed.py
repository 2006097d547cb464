"""What jobs can execute, including the runnables that they call, and whether the model states how long it takes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from amalthea_uros.perf.activities import (
    Activity,
    Call,
    Execute,
    ExecutionNeed,
    Group,
    ProbabilitySwitch,
    Switch,
    walk,
)
from amalthea_uros.perf.distributions import Bounds
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.system import System

#: Processes with deeper calls are not analysed.
MAX_CALL_DEPTH = 100


def executed(activities: Sequence[Activity], system: System) -> Iterable[Activity]:
    """All activities that a job can execute, including those of called runnables; each runnable once."""
    seen: set[str] = set()
    pending = [tuple(activities)]
    while pending:
        for activity in walk(pending.pop()):
            yield activity
            if isinstance(activity, Call) and activity.runnable in system.runnables and activity.runnable not in seen:
                seen.add(activity.runnable)
                pending.append(system.runnables[activity.runnable].activities)


def ends_with_execution(activities: Sequence[Activity], system: System, depth: int = 0) -> bool:
    """Whether the last that a job does certainly takes time, so that nothing is left once its demand is served."""
    if not activities or depth > MAX_CALL_DEPTH:
        return False
    inner: list[Sequence[Activity]]
    match activities[-1]:
        case Execute() | ExecutionNeed():
            return True
        case Call(runnable=name, counter=None, times=None) if name in system.runnables:
            runnable = system.runnables[name]
            inner = [runnable.activities if runnable.condition is None else ()]
        case Group(ordered=True, activities=of_group):
            inner = [of_group]
        case Switch(cases=cases, default=default):
            inner = [*(case.activities for case in cases), default or ()]
        case ProbabilitySwitch(branches=branches):
            inner = [branch.activities for branch in branches]
        case _:
            return False
    return all(ends_with_execution(each, system, depth + 1) for each in inner)


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
