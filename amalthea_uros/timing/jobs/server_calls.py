"""Server calls: who executes the runnable of a call, and whether the client waits for another process.

A runnable is executed by the processes that call it. A server runnable that no process calls is executed by its clients: a
synchronous call is a function call then, as in AUTOSAR, where a server runnable need not be mapped to a task (Specification of RTE
Software). If others than synchronous calls refer to it, it is unknown who executes it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from amalthea_uros._internal.graphs import bottom_up
from amalthea_uros.perf.activities import (
    Activity,
    Call,
    Group,
    Loop,
    ProbabilitySwitch,
    SenderReceiverAccess,
    ServerCall,
    ServerCallKind,
    Switch,
    walk,
)
from amalthea_uros.perf.software import Process, Runnable
from amalthea_uros.perf.system import System


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
    software = system.software
    everything = [activity for body in software.bodies for activity in walk(body)]
    wanted = {call.runnable for call in everything if isinstance(call, ServerCall) and _is_synchronous(call)}
    others = {name for activity in everything for name in _referred(activity)}
    direct = (wanted & set(system.runnables)) - others - set(servers(system))
    if not direct:
        return system
    return replace(
        system,
        software=replace(
            software,
            tasks=tuple(replace(task, activities=_direct(task.activities, direct)) for task in software.tasks),
            isrs=tuple(replace(isr, activities=_direct(isr.activities, direct)) for isr in software.isrs),
            runnables=tuple(replace(item, activities=_direct(item.activities, direct)) for item in software.runnables),
        ),
    )


def _is_synchronous(call: ServerCall) -> bool:
    return call.kind is ServerCallKind.SYNCHRONOUS and call.waits


def _called(item: Process | Runnable | None) -> Iterator[str]:
    """The runnables that a process or runnable calls itself."""
    activities = item.activities if item is not None else ()
    return (activity.runnable for activity in walk(activities) if isinstance(activity, Call))


def _referred(activity: Activity) -> Iterator[str]:
    """The runnables that an activity causes to be executed later, or elsewhere."""
    match activity:
        case ServerCall(runnable=runnable, result=result) if not _is_synchronous(activity):
            yield runnable
            if result is not None:
                yield result
        case SenderReceiverAccess(notifies=notifies):
            yield from notifies


def _direct(activities: Iterable[Activity], direct: set[str]) -> tuple[Activity, ...]:
    return tuple(_directly(activity, direct) for activity in activities)


def _directly(activity: Activity, direct: set[str]) -> Activity:
    """An activity in which the synchronous calls of some server runnables are calls."""
    match activity:
        case ServerCall(runnable=name) if name in direct and _is_synchronous(activity):
            call = Call(runnable=name, locate=activity.locate)
            return Group(activities=(replace(activity, waits=False), call), locate=activity.locate)
        case Group() | Loop():
            return replace(activity, activities=_direct(activity.activities, direct))
        case ProbabilitySwitch(branches=branches):
            return replace(activity, branches=tuple(replace(b, activities=_direct(b.activities, direct)) for b in branches))
        case Switch(cases=cases, default=default):
            return replace(
                activity,
                cases=tuple(replace(case, activities=_direct(case.activities, direct)) for case in cases),
                default=None if default is None else _direct(default, direct),
            )
    return activity
