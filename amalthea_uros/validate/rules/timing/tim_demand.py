"""Process that takes no time."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ISR, ExecutionNeed, Process, RunnableCall, Task, Ticks
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Process, context: Context) -> Iterator[str]:
    if isinstance(element, Task | ISR) and not any(isinstance(part, Ticks | ExecutionNeed) for part in _executed(element)):
        yield f"neither {element.name!r} nor a runnable that it calls has an execution time"


def _executed(process: Process) -> Iterator[Element]:
    pending: list[Element] = [process]
    seen = set()
    while pending:
        for part in pending.pop().walk():
            yield part
            if isinstance(part, RunnableCall) and part.runnable is not None and part.runnable not in seen:
                seen.add(part.runnable)
                pending.append(part.runnable)


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
