"""Incomplete task allocation."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import TaskAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, ModelRule
from amalthea_uros.validate.rules.inchron._missing import missing


def _check(element: TaskAllocation, context: Context) -> Iterator[str | Downgraded]:
    absent = missing({"task": element.task, "scheduler": element.scheduler})
    if absent:
        message = f"the task allocation has no {absent}"
        yield message if element.task is None else Downgraded(message)


RULE = ModelRule(
    id="INC-MAP-TASK",
    title="incomplete task allocation",
    severity=Severity.ERROR,
    target=TaskAllocation,
    check=_check,
    rationale="am2inc crashes with a segmentation fault if the task is missing. If only the scheduler is missing, the task "
    "disappears (warning).",
    remedy="Set the task and the scheduler.",
    fails="""
<osModel>
  <operatingSystems name="OS">
    <taskSchedulers name="S"/>
  </operatingSystems>
</osModel>
<swModel>
  <tasks name="T"/>
</swModel>
<mappingModel>
  <taskAllocation scheduler="S?type=TaskScheduler"/>
</mappingModel>
""",
    edits={'scheduler="S?type=TaskScheduler"': 'task="T?type=Task" scheduler="S?type=TaskScheduler"'},
)
