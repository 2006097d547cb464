"""Runnable that no process executes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    AsynchronousServerCall,
    IExecutable,
    Process,
    Runnable,
    SenderReceiverWrite,
    ServerCall,
)
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.execution import called
from amalthea_uros.validate.graphs import bottom_up
from amalthea_uros.validate.rule import ModelRule


def _check(element: Runnable, context: Context) -> Iterator[str]:
    if element not in context.once(_executed):
        yield f"no process executes the runnable {element.name!r}"


def _executed(context: Context) -> set[IExecutable]:
    """What processes execute, and what they make others execute."""
    caused: dict[IExecutable | None, list[Runnable | None]] = {}
    for call in context.all(ServerCall):
        caused.setdefault(call.enclosing(IExecutable), []).append(call.server_runnable)
    for request in context.all(AsynchronousServerCall):
        caused.setdefault(request.enclosing(IExecutable), []).append(request.result_runnable)
    for write in context.all(SenderReceiverWrite):
        caused.setdefault(write.enclosing(IExecutable), []).extend(write.notified_runnables)

    def next_to(item: IExecutable) -> Iterator[IExecutable]:
        yield from called(item, context)
        yield from (runnable for runnable in caused.get(item, ()) if runnable is not None)

    starts: Sequence[IExecutable] = context.all(Process)
    return set(bottom_up(starts, next_to))


RULE = ModelRule(
    id="TIM-UNREACHABLE",
    title="runnable that no process executes",
    severity=Severity.INFO,
    target=Runnable,
    check=_check,
    rationale="It never runs; if it should, its time is missing in the load.",
    remedy="Call it in a task, directly or by way of other runnables, or remove it.",
    fails="""
<swModel>
  <runnables name="R"/>
</swModel>
""",
    passes="""
<swModel>
  <tasks name="T">
    <activityGraph>
      <items xsi:type="am:RunnableCall" runnable="R?type=Runnable"/>
    </activityGraph>
  </tasks>
  <runnables name="R"/>
</swModel>
""",
)
