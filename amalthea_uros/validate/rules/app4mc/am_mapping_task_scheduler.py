"""Task without a scheduler."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Task, TaskAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Task, context: Context) -> Iterator[str]:
    if not context.uses(TaskAllocation, "task")[element]:
        yield f"no task allocation refers to {element.name!r}"


RULE = ModelRule(
    id="AM-Mapping-Task-Scheduler",
    title="task without a scheduler",
    severity=Severity.WARNING,
    target=Task,
    check=_check,
    rationale="It is not served by anything. APP4MC reports it when it validates the model.",
    remedy="Allocate it to a task scheduler.",
    fails="""
<swModel>
  <tasks name="T"/>
</swModel>
""",
    passes="""
<swModel>
  <tasks name="T"/>
</swModel>
<mappingModel>
  <taskAllocation task="T?type=Task"/>
</mappingModel>
""",
)
