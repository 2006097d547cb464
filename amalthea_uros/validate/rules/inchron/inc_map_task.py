"""Incomplete task allocation."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import TaskAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: TaskAllocation, context: Context) -> Iterator[str]:
    if element.task is None or element.scheduler is None:
        yield "the task allocation lacks its task or its scheduler"


RULE = ModelRule(
    id="INC-MAP-TASK",
    title="incomplete task allocation",
    severity=Severity.ERROR,
    target=TaskAllocation,
    check=_check,
    rationale="am2inc ends with a segmentation fault, or the task vanishes.",
    remedy="Name the task and its scheduler.",
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
  <taskAllocation task="T?type=Task"/>
</mappingModel>
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
