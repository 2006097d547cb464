"""What jobs can execute, how often, who executes what they call, and whether the model states how long it takes.

A runnable is executed by the processes that call it. A server runnable that no process calls is executed by its clients: a
synchronous call is a function call then, as in AUTOSAR, where a server runnable need not be mapped to a task (Specification of RTE
Software). If others than synchronous calls refer to it, it is unknown who executes it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from math import isfinite

from amalthea_uros._internal.graphs import bottom_up
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import (
    Activity,
    Call,
    Count,
    Execute,
    ExecutionNeed,
    Group,
    ProbabilitySwitch,
    SenderReceiverAccess,
    ServerCall,
    ServerCallKind,
    Switch,
    called_runnables,
    walk,
)
from amalthea_uros.perf.distributions import Bounds
from amalthea_uros.perf.software import Process, Runnable
from amalthea_uros.perf.system import System
from amalthea_uros.units import down, up

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
    if depends_on_messages(process.name, system):
        return False
    demands = (each.demand for each in executed(process.activities, system) if isinstance(each, Execute))
    every = (ticks for demand in demands for ticks in (demand.ticks, *dict(demand.by_core_type).values()))
    return not any(isinstance(ticks, Bounds) for ticks in every)


def depends_on_messages(process: str, system: System) -> bool:
    """Whether a process is an executor of which it is not specified how often it iterates, or which callbacks an iteration calls.

    The branches of an iteration have weights only because a switch of the model needs some.
    """
    executor = system.executor_of_task.get(process)
    if executor is None:
        return False
    activities = walk(system.processes[process].activities)
    return executor.loop.period is None or any(isinstance(each, ProbabilitySwitch) for each in activities)


def _is_stated(activity: object) -> bool:
    match activity:
        case Execute(demand=demand):
            return demand.ticks is not None or bool(demand.by_core_type)
        case ExecutionNeed(needs=needs):
            return bool(needs)
    return False


#: Minimum, mean and maximum number of a single execution.
_ONCE = (1, Fraction(1), 1)


def count_of(times: Count | float | None) -> tuple[int, Fraction, int]:
    """Minimum, mean and maximum number of executions that one activity of the model represents.

    Raises
    ------
    UnknownError : they are negative or in the wrong order, as if only a mean is stated and the maximum is 0.
    """
    if times is None:
        return _ONCE
    try:
        number = Fraction(1 if isinstance(times, Count) else times)
        found = (
            (times.least, Fraction(times.mean), times.most) if isinstance(times, Count) else (down(number), number, up(number))
        )
    except (ValueError, OverflowError):
        raise UnknownError("a number of calls or accesses is not finite") from None
    if not 0 <= found[0] <= found[1] <= found[2]:
        raise UnknownError("a number of calls or accesses is negative, or its mean is not between its minimum and maximum")
    return found


def is_average(times: Count | float | None) -> bool:
    """Whether a number is an average without bounds: it is usually measured, and a fraction can be nothing else."""
    return isinstance(times, float) and isfinite(times) and not times.is_integer()


@lru_cache(maxsize=1024)
def bounds_of(times: Count | float | None) -> tuple[int, int | None]:
    """The least number of executions, and the greatest one; None if it is unknown."""
    if times is None:
        return 1, 1
    try:
        least, _, most = count_of(times)
    except UnknownError:
        return 0, None
    return (0, None) if is_average(times) else (least, most)


def servers(system: System) -> Mapping[str, tuple[str, ...]]:
    """The processes that call each runnable, directly or through other runnables."""
    found: dict[str, tuple[str, ...]] = {}
    for process in system.processes.values():
        for name in bottom_up(_called(process), lambda name: _called(system.runnables.get(name))):
            found[name] = (*found.get(name, ()), process.name)
    return found


def obstacle(activity: ServerCall | SenderReceiverAccess, executing: Mapping[str, tuple[str, ...]]) -> str:
    """Why the time that a server call or a notifying access takes is unknown; empty if it is known.

    Parameters
    ----------
    executing : the result of `servers`
    """
    match activity:
        case ServerCall(kind=ServerCallKind.ASYNCHRONOUS, runnable=runnable, result=result):
            needed = [("server", runnable), *([] if result is None else [("result", result)])]
        case ServerCall(runnable=runnable, waits=True):
            who = " and ".join(map(repr, executing.get(runnable, ()))) or "no process"
            return f"it waits for the server runnable {runnable!r}, which {who} executes"
        case SenderReceiverAccess(notifies=notifies):
            needed = [("notified", name) for name in notifies]
        case _:
            return ""
    missing = (f"no process executes the {role} runnable {name!r}" for role, name in needed if name not in executing)
    return next(missing, "")


def with_direct_calls(system: System) -> System:
    """The system with synchronous server calls as calls within the client, where no process executes the server runnable.

    What is left of such a server call is one that does not wait, for the overhead of the operating system.
    """
    if ServerCall not in system.activity_classes:
        return system
    everything = [activity for body in system.software.bodies for activity in walk(body)]
    wanted = {call.runnable for call in everything if isinstance(call, ServerCall) and _is_synchronous(call)}
    others = {name for activity in everything for name in _referred(activity)}
    direct = (wanted & set(system.runnables)) - others - set(servers(system))
    if not direct:
        return system

    def directly(activity: Activity) -> Activity:
        match activity:
            case ServerCall(runnable=name) if name in direct and _is_synchronous(activity):
                call = Call(runnable=name, locate=activity.locate)
                return Group(activities=(replace(activity, waits=False), call), locate=activity.locate)
        return activity

    return system.with_activities(directly)


def _is_synchronous(call: ServerCall) -> bool:
    return call.kind is ServerCallKind.SYNCHRONOUS and call.waits


def _called(item: Process | Runnable | None) -> Iterator[str]:
    """The runnables that a process or runnable calls itself."""
    activities = item.activities if item is not None else ()
    return called_runnables(activities)


def _referred(activity: Activity) -> Iterator[str]:
    """The runnables that an activity causes to be executed later, or elsewhere."""
    match activity:
        case ServerCall(runnable=runnable, result=result) if not _is_synchronous(activity):
            yield runnable
            if result is not None:
                yield result
        case SenderReceiverAccess(notifies=notifies):
            yield from notifies
