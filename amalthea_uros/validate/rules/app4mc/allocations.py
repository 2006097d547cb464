"""Processes and schedulers without an allocation."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ISR, ISRAllocation, Scheduler, SchedulerAllocation, Task, TaskAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import SCHEDULER
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.scheduling import GROUPING, policy


def _check_task(element: Task, context: Context) -> Iterator[str]:
    if not context.uses(TaskAllocation, "task")[element]:
        yield f"task {element.name!r} has no task allocation"


def _check_isr(element: ISR, context: Context) -> Iterator[str]:
    if not context.uses(ISRAllocation, "isr")[element]:
        yield f"ISR {element.name!r} has no ISR allocation"


def _check_scheduler(element: Scheduler, context: Context) -> Iterator[str]:
    if policy(element) != GROUPING and not context.uses(SchedulerAllocation, "scheduler")[element]:
        yield f"scheduler {element.name!r} has no scheduler allocation"


RULES = (
    ModelRule(
        id="AM-Mapping-Task-Scheduler",
        title="task without a scheduler",
        severity=Severity.WARNING,
        target=Task,
        check=_check_task,
        rationale="Without an allocation, no scheduler runs the task. APP4MC's validation also reports it.",
        remedy="Allocate the task to a task scheduler.",
        fails="""
<swModel>
  <tasks name="T"/>
</swModel>
""",
        edits={
            "</swModel>": """</swModel>
<mappingModel>
  <taskAllocation task="T?type=Task"/>
</mappingModel>""",
        },
    ),
    ModelRule(
        id="AM-Mapping-ISR-Scheduler",
        title="interrupt service routine without an interrupt controller",
        severity=Severity.WARNING,
        target=ISR,
        check=_check_isr,
        rationale="Without an allocation, no interrupt controller serves the ISR. APP4MC's validation also reports it.",
        remedy="Allocate the ISR to an interrupt controller.",
        fails="""
<swModel>
  <isrs name="I"/>
</swModel>
""",
        edits={
            "</swModel>": """</swModel>
<mappingModel>
  <isrAllocation isr="I?type=ISR"/>
</mappingModel>""",
        },
    ),
    ModelRule(
        id="AM-Mapping-Scheduler-ProcessingUnit",
        title="scheduler without a processing unit",
        severity=Severity.WARNING,
        target=Scheduler,
        check=_check_scheduler,
        rationale="Without an allocation, the scheduler controls no processing unit. APP4MC's validation also reports it.",
        remedy="Add a scheduler allocation with the processing units of the scheduler.",
        fails=f"""
{SCHEDULER}
""",
        edits={
            "</osModel>": """</osModel>
<mappingModel>
  <schedulerAllocation scheduler="S?type=TaskScheduler"/>
</mappingModel>""",
        },
    ),
)
