"""Process without a place."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ISR, ISRAllocation, Process, Task, TaskAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Process, context: Context) -> Iterator[str]:
    times = context.uses(TaskAllocation, "task")[element] + context.uses(ISRAllocation, "isr")[element]
    if isinstance(element, Task | ISR) and not times:
        yield f"{element.name!r} is allocated to no scheduler and no interrupt controller"


RULE = ModelRule(
    id="TIM-ALLOCATION",
    title="process without a place",
    severity=Severity.WARNING,
    target=Process,
    check=_check,
    rationale="It is not known which core serves it, and by which policy; its load is missing everywhere.",
    remedy="Allocate it to a task scheduler or an interrupt controller.",
    fails="""
<swModel>
  <tasks name="T"/>
</swModel>
""",
    passes="""
<osModel>
  <operatingSystems name="OS">
    <taskSchedulers name="S"/>
  </operatingSystems>
</osModel>
<swModel>
  <tasks name="T"/>
</swModel>
<mappingModel>
  <taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler"/>
</mappingModel>
""",
)
