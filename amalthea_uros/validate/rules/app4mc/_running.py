"""Which processes run which runnables."""

from __future__ import annotations

from amalthea_uros.metamodel.classes import Process, Runnable, RunnableCall
from amalthea_uros.validate.context import Context

Caller = Process | Runnable


def direct_calls(context: Context) -> dict[Caller, list[Runnable]]:
    """The runnables that each process and each runnable calls itself."""
    found: dict[Caller, list[Runnable]] = {}
    for call in context.all(RunnableCall):
        caller = call.enclosing(Runnable) or call.enclosing(Process)
        if caller is not None and call.runnable is not None:
            found.setdefault(caller, []).append(call.runnable)
    return found


def processes_of_runnables(context: Context) -> dict[Runnable, list[Process]]:
    """The processes in which each runnable runs, called by them or by what they call."""
    calls = context.once(direct_calls)
    found: dict[Runnable, list[Process]] = {}
    for process in (caller for caller in calls if isinstance(caller, Process)):
        reached: dict[Runnable, None] = {}
        pending: list[Caller] = [process]
        while pending:
            for called in calls.get(pending.pop(), []):
                if called not in reached:
                    reached[called] = None
                    pending.append(called)
        for runnable in reached:
            found.setdefault(runnable, []).append(process)
    return found
