"""Scheduler without a processing unit."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Scheduler, SchedulerAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.scheduling import GROUPING, policy


def _check(element: Scheduler, context: Context) -> Iterator[str]:
    if policy(element) != GROUPING and not context.uses(SchedulerAllocation, "scheduler")[element]:
        yield f"scheduler {element.name!r} has no scheduler allocation"


RULE = ModelRule(
    id="AM-Mapping-Scheduler-ProcessingUnit",
    title="scheduler without a processing unit",
    severity=Severity.WARNING,
    target=Scheduler,
    check=_check,
    rationale="Without an allocation, the scheduler controls no processing unit. APP4MC's validation also reports it.",
    remedy="Add a scheduler allocation with the processing units of the scheduler.",
    fails="""
<osModel>
  <operatingSystems name="OS">
    <taskSchedulers name="S"/>
  </operatingSystems>
</osModel>
""",
    edits={
        "</osModel>": """</osModel>
<mappingModel>
  <schedulerAllocation scheduler="S?type=TaskScheduler"/>
</mappingModel>""",
    },
)
