"""What executes what: processes call runnables, and these call others."""

from __future__ import annotations

from collections.abc import Mapping
from math import ceil, isfinite

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


def order(context: Context) -> list[IExecutable]:
    """All that processes execute, runnables before their callers."""
    return context.once(_order)


def _order(context: Context) -> list[IExecutable]:
    return bottom_up(context.all(Process), lambda caller: called(caller, context))


def executions(context: Context) -> Mapping[IExecutable, Mapping[Process, int]]:
    """How often at most a job of each process executes a process or runnable: itself once."""
    return context.once(_executions)


def _executions(context: Context) -> dict[IExecutable, dict[Process, int]]:
    found: dict[IExecutable, dict[Process, int]] = {process: {process: 1} for process in context.all(Process)}
    done: set[IExecutable] = set()
    for caller in reversed(order(context)):
        done.add(caller)
        for call in calls(context).get(caller, ()):
            # Within a circle nothing is counted twice.
            if call.runnable is not None and call.runnable not in done:
                _add(found.setdefault(call.runnable, {}), found.get(caller, {}), times(call))
    return found


def _add(counts: dict[Process, int], others: Mapping[Process, int], factor: int) -> None:
    for process, count in others.items():
        if count * factor:
            counts[process] = counts.get(process, 0) + count * factor


def times(call: RunnableCall) -> int:
    """How often a call is performed at most; once if nothing is stated."""
    match call.statistic and call.statistic.statistic:
        case MinAvgMaxStatistic(max=most):
            return most or 0
        case SingleValueStatistic(value=value):
            return ceil(value) if value and isfinite(value) else 0
    return 1


def executing(item: Element, context: Context) -> Mapping[Process, int]:
    """The processes in whose jobs something is executed, and how often at most its process or runnable is."""
    holder = item if isinstance(item, IExecutable) else item.enclosing(IExecutable)
    return executions(context).get(holder, {}) if holder is not None else {}
