"""Process without a unique allocation."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ISR, ISRAllocation, Process, Task, TaskAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import SCHEDULER
from amalthea_uros.validate.rule import ModelRule


def _check(element: Process, context: Context) -> Iterator[str]:
    if not isinstance(element, Task | ISR):
        return
    times = context.once(_allocations)[element]
    if times == 0:
        yield f"{element.name!r} is not allocated to a scheduler or an interrupt controller"
    elif times > 1:
        yield f"{element.name!r} is allocated {times} times"


def _allocations(context: Context) -> Counter[Process]:
    """How often each process is allocated to a scheduler or an interrupt controller."""
    tasks = (allocation.task for allocation in context.all(TaskAllocation) if allocation.scheduler is not None)
    isrs = (allocation.isr for allocation in context.all(ISRAllocation) if allocation.controller is not None)
    return Counter(process for process in (*tasks, *isrs) if process is not None)


RULE = ModelRule(
    id="TIM-ALLOCATION",
    title="process without a unique allocation",
    severity=Severity.WARNING,
    target=Process,
    check=_check,
    rationale="The core and the scheduling policy of the process are unknown. Its load is missing, or counted for only one of "
    "several cores.",
    remedy="Allocate the process to exactly one task scheduler or interrupt controller.",
    fails="""
<swModel>
  <tasks name="T"/>
</swModel>
""",
    passes=f"""
{SCHEDULER}
<swModel>
  <tasks name="T"/>
</swModel>
<mappingModel>
  <taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler"/>
</mappingModel>
""",
)
