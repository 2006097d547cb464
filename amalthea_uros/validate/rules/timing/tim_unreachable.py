"""Unreachable runnable."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from amalthea_uros._internal.graphs import bottom_up
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
from amalthea_uros.validate.rule import ModelRule


def _check(element: Runnable, context: Context) -> Iterator[str]:
    if element not in context.once(_executed):
        yield f"runnable {element.name!r} is not executed by any process"


def _executed(context: Context) -> set[IExecutable]:
    """Everything that processes execute or cause to be executed."""
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
    title="unreachable runnable",
    severity=Severity.INFO,
    target=Runnable,
    check=_check,
    rationale="The runnable never runs. If it should, its execution time is missing from the load.",
    remedy="Call it from a task, directly or through other runnables, or remove it.",
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
