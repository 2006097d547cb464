"""Process without an execution time."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros._internal.graphs import bottom_up
from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ISR, ExecutionNeed, IExecutable, Process, Task, Ticks
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.execution import callers
from amalthea_uros.validate.rule import ModelRule


def _check(element: Process, context: Context) -> Iterator[str]:
    if isinstance(element, Task | ISR) and element not in context.once(_demanding):
        yield f"{element.name!r} has no execution time, and neither have the runnables that it calls"


def _demanding(context: Context) -> set[IExecutable]:
    """The processes and runnables that take time, directly or through the runnables that they call."""
    ticks = (item for item in context.all(Ticks) if item.default is not None or item.extended)
    needs = (item for item in context.all(ExecutionNeed) if item.needs)
    holders = (item.enclosing(IExecutable) for item in (*ticks, *needs))
    return set(bottom_up((holder for holder in holders if holder is not None), lambda item: callers(item, context)))


RULE = ModelRule(
    id="TIM-DEMAND",
    title="process without an execution time",
    severity=Severity.WARNING,
    target=Process,
    check=_check,
    rationale="Without ticks or execution needs, the execution time and the load of the process are 0.",
    remedy="Add ticks or execution needs to the process, or to the runnables that it calls.",
    fails="""
<swModel>
  <tasks name="T"/>
</swModel>
""",
    passes="""
<swModel>
  <tasks name="T">
    <activityGraph>
      <items xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueConstant" value="1"/>
      </items>
    </activityGraph>
  </tasks>
</swModel>
""",
)
