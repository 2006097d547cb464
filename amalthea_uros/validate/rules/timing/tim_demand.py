"""Process that takes no time."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ISR, ExecutionNeed, IExecutable, Process, Task, Ticks
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.execution import callers
from amalthea_uros.validate.graphs import bottom_up
from amalthea_uros.validate.rule import ModelRule


def _check(element: Process, context: Context) -> Iterator[str]:
    if isinstance(element, Task | ISR) and element not in context.once(_demanding):
        yield f"neither {element.name!r} nor a runnable that it calls has an execution time"


def _demanding(context: Context) -> set[IExecutable]:
    """The processes and runnables that take time, themselves or by what they call."""
    ticks = (item for item in context.all(Ticks) if item.default is not None or item.extended)
    needs = (item for item in context.all(ExecutionNeed) if item.needs)
    holders = (item.enclosing(IExecutable) for item in (*ticks, *needs))
    return set(bottom_up((holder for holder in holders if holder is not None), lambda item: callers(item, context)))


RULE = ModelRule(
    id="TIM-DEMAND",
    title="process that takes no time",
    severity=Severity.WARNING,
    target=Process,
    check=_check,
    rationale="Without Ticks or execution needs its execution time is 0, and so is its share of the load.",
    remedy="State the execution time in the runnables that it calls.",
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
