"""What executes what: processes call runnables, and these call others."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from amalthea_uros._internal.graphs import bottom_up
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context


def calls(context: Context) -> Mapping[am.IExecutable, list[am.RunnableCall]]:
    """The calls that stand in each process and runnable."""
    return context.once(_calls)


def _calls(context: Context) -> dict[am.IExecutable, list[am.RunnableCall]]:
    found: dict[am.IExecutable, list[am.RunnableCall]] = {}
    for call in context.all(am.RunnableCall):
        caller = call.enclosing(am.IExecutable)
        if caller is not None and call.runnable is not None:
            found.setdefault(caller, []).append(call)
    return found


def called(caller: am.IExecutable, context: Context) -> list[am.Runnable]:
    """The runnables that a process or runnable calls itself."""
    return [call.runnable for call in calls(context).get(caller, ()) if call.runnable is not None]


def waited_for(caller: am.IExecutable, context: Context) -> list[am.Runnable]:
    """The runnables before whose end a process or runnable does not end: those it calls, also by a server."""
    return [*called(caller, context), *context.once(_servers).get(caller, ())]


def callers(item: am.IExecutable, context: Context) -> list[am.IExecutable]:
    """Who waits for the end of a runnable: the other direction."""
    return context.once(_callers).get(item, [])


def _callers(context: Context) -> dict[am.IExecutable, list[am.IExecutable]]:
    found: dict[am.IExecutable, list[am.IExecutable]] = {}
    for caller in context.all(am.IExecutable):
        for item in waited_for(caller, context):
            found.setdefault(item, []).append(caller)
    return found


def _servers(context: Context) -> dict[am.IExecutable, list[am.Runnable]]:
    found: dict[am.IExecutable, list[am.Runnable]] = {}
    for call in context.all(am.SynchronousServerCall):
        caller = call.enclosing(am.IExecutable)
        if caller is not None and call.server_runnable is not None:
            found.setdefault(caller, []).append(call.server_runnable)
    return found


def executing(item: Element, context: Context) -> Collection[am.Process]:
    """The processes in whose jobs something is executed, in the order of the model."""
    holder = item if isinstance(item, am.IExecutable) else item.enclosing(am.IExecutable)
    return context.once(_executing).get(holder, {}) if holder is not None else {}


def _executing(context: Context) -> dict[am.IExecutable, dict[am.Process, None]]:
    """The processes that execute each process or runnable, as the keys of a mapping, which keeps their order."""
    found: dict[am.IExecutable, dict[am.Process, None]] = {}
    for process in context.all(am.Process):
        starts: list[am.IExecutable] = [process]
        for item in bottom_up(starts, lambda caller: _executed(caller, context)):
            found.setdefault(item, {})[process] = None
    return found


def _executed(caller: am.IExecutable, context: Context) -> Iterator[am.Runnable]:
    return (call.runnable for call in calls(context).get(caller, ()) if call.runnable is not None and _is_performed(call))


def _is_performed(call: am.RunnableCall) -> bool:
    """Whether a job performs a call at all: the statistic of a call may say that it never does."""
    match call.statistic and call.statistic.statistic:
        case am.MinAvgMaxStatistic(max=most):
            return bool(most)
        case am.SingleValueStatistic(value=value):
            return bool(value)
    return True
