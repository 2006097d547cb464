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
        yield f"no scheduler allocation refers to {element.name!r}"


RULE = ModelRule(
    id="AM-Mapping-Scheduler-ProcessingUnit",
    title="scheduler without a processing unit",
    severity=Severity.WARNING,
    target=Scheduler,
    check=_check,
    rationale="It decides for nothing. APP4MC reports it when it validates the model.",
    remedy="Give it a scheduler allocation.",
    fails="""
<osModel>
  <operatingSystems name="OS">
    <taskSchedulers name="S"/>
  </operatingSystems>
</osModel>
""",
    passes="""
<osModel>
  <operatingSystems name="OS">
    <taskSchedulers name="S"/>
  </operatingSystems>
</osModel>
<mappingModel>
  <schedulerAllocation scheduler="S?type=TaskScheduler"/>
</mappingModel>
""",
)
