"""Task without an allowed processing unit."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import TaskAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import SCHEDULER
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.scheduling import responsibilities


def _check(element: TaskAllocation, context: Context) -> Iterator[str]:
    task, scheduler = element.task, element.scheduler
    if task is None or scheduler is None or scheduler.unresolved is not None:
        return
    served = responsibilities(context).get(scheduler, [])
    if not served:
        yield f"task {task.qualified_name!r} cannot run: {scheduler.name!r} is responsible for no processing unit"
    elif element.affinity and set(served).isdisjoint(element.affinity):
        yield f"task {task.qualified_name!r} cannot run: {scheduler.name!r} is responsible for no processing unit of its affinity"


RULE = ModelRule(
    id="DOC-Task-Affinity-Intersection",
    title="task without an allowed processing unit",
    severity=Severity.ERROR,
    target=TaskAllocation,
    check=_check,
    rationale="A task runs only on processing units that are in its affinity, if it has one, and in the responsibility of its "
    "scheduler. The APP4MC documentation requires at least one.",
    remedy="Add a processing unit of the scheduler to the affinity, or extend the responsibility of the scheduler.",
    fails=f"""
<swModel>
  <tasks name="T"/>
</swModel>
<hwModel>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="a"/>
    <modules xsi:type="am:ProcessingUnit" name="b"/>
  </structures>
</hwModel>
{SCHEDULER}
<mappingModel>
  <schedulerAllocation scheduler="S?type=TaskScheduler" responsibility="a?type=ProcessingUnit"/>
  <taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler" affinity="b?type=ProcessingUnit"/>
</mappingModel>
""",
    edits={'affinity="b?type=ProcessingUnit"': 'affinity="a?type=ProcessingUnit"'},
)
