"""Task without a scheduler."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Task, TaskAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Task, context: Context) -> Iterator[str]:
    if not context.uses(TaskAllocation, "task")[element]:
        yield f"task {element.name!r} has no task allocation"


RULE = ModelRule(
    id="AM-Mapping-Task-Scheduler",
    title="task without a scheduler",
    severity=Severity.WARNING,
    target=Task,
    check=_check,
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
)
