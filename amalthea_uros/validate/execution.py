"""What executes what: processes call runnables, and these call others."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from amalthea_uros._internal.graphs import bottom_up
from amalthea_uros.metamodel.classes import (
    IExecutable,
    MinAvgMaxStatistic,
    Process,
    Runnable,
    RunnableCall,
    SingleValueStatistic,
    SynchronousServerCall,
)
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context


def calls(context: Context) -> Mapping[IExecutable, list[RunnableCall]]:
    """The calls that stand in each process and runnable."""
    return context.once(_calls)


def _calls(context: Context) -> dict[IExecutable, list[RunnableCall]]:
    found: dict[IExecutable, list[RunnableCall]] = {}
    for call in context.all(RunnableCall):
        caller = call.enclosing(IExecutable)
        if caller is not None and call.runnable is not None:
            found.setdefault(caller, []).append(call)
    return found


def called(caller: IExecutable, context: Context) -> list[Runnable]:
    """The runnables that a process or runnable calls itself."""
    return [call.runnable for call in calls(context).get(caller, ()) if call.runnable is not None]


def waited_for(caller: IExecutable, context: Context) -> list[Runnable]:
    """The runnables before whose end a process or runnable does not end: those it calls, also by a server."""
    return [*called(caller, context), *context.once(_servers).get(caller, ())]


def callers(item: IExecutable, context: Context) -> list[IExecutable]:
    """Who waits for the end of a runnable: the other direction."""
    return context.once(_callers).get(item, [])


def _callers(context: Context) -> dict[IExecutable, list[IExecutable]]:
    found: dict[IExecutable, list[IExecutable]] = {}
    for caller in context.all(IExecutable):
        for item in waited_for(caller, context):
            found.setdefault(item, []).append(caller)
    return found


def _servers(context: Context) -> dict[IExecutable, list[Runnable]]:
    found: dict[IExecutable, list[Runnable]] = {}
    for call in context.all(SynchronousServerCall):
        caller = call.enclosing(IExecutable)
        if caller is not None and call.server_runnable is not None:
            found.setdefault(caller, []).append(call.server_runnable)
    return found


def executing(item: Element, context: Context) -> Collection[Process]:
    """The processes in whose jobs something is executed, in the order of the model."""
    holder = item if isinstance(item, IExecutable) else item.enclosing(IExecutable)
    return context.once(_executing).get(holder, {}) if holder is not None else {}


def _executing(context: Context) -> dict[IExecutable, dict[Process, None]]:
    """The processes that execute each process or runnable, as the keys of a mapping, which keeps their order."""
    found: dict[IExecutable, dict[Process, None]] = {}
    for process in context.all(Process):
        starts: list[IExecutable] = [process]
        for item in bottom_up(starts, lambda caller: _executed(caller, context)):
            found.setdefault(item, {})[process] = None
    return found


def _executed(caller: IExecutable, context: Context) -> Iterator[Runnable]:
    return (call.runnable for call in calls(context).get(caller, ()) if call.runnable is not None and _is_performed(call))


def _is_performed(call: RunnableCall) -> bool:
    """Whether a job performs a call at all: the statistic of a call may say that it never does."""
    match call.statistic and call.statistic.statistic:
        case MinAvgMaxStatistic(max=most):
            return bool(most)
        case SingleValueStatistic(value=value):
            return bool(value)
    return True
