"""Task with several schedulers."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Task, TaskAllocation, TaskScheduler
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.wording import joined


def _check(element: TaskAllocation, context: Context) -> Iterator[str]:
    task = element.task
    schedulers = context.once(_schedulers).get(task, {}) if task is not None else {}
    if task is not None and len(schedulers) > 1:
        yield f"task {task.qualified_name!r} is allocated to {joined(repr(each.qualified_name) for each in schedulers)}"


def _schedulers(context: Context) -> dict[Task, dict[TaskScheduler, None]]:
    found: dict[Task, dict[TaskScheduler, None]] = {}
    for allocation in context.all(TaskAllocation):
        if allocation.task is not None and allocation.scheduler is not None:
            found.setdefault(allocation.task, {})[allocation.scheduler] = None
    return found


RULE = ModelRule(
    id="DOC-Task-Single-Scheduler",
    title="task with several schedulers",
    severity=Severity.ERROR,
    target=TaskAllocation,
    check=_check,
    rationale="It is undefined which scheduler runs the task. The APP4MC documentation requires exactly one scheduler per task.",
    remedy="Allocate the task to one scheduler. To use several processing units, choose a scheduler that is responsible for "
    "all of them.",
    fails="""
<swModel>
  <tasks name="T"/>
</swModel>
<osModel>
  <operatingSystems name="OS">
    <taskSchedulers name="S"/>
    <taskSchedulers name="R"/>
  </operatingSystems>
</osModel>
<mappingModel>
  <taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler"/>
  <taskAllocation task="T?type=Task" scheduler="R?type=TaskScheduler"/>
</mappingModel>
""",
    edits={'  <taskAllocation task="T?type=Task" scheduler="R?type=TaskScheduler"/>\n': ""},
)
