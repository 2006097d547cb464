"""Scheduler without a core."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Scheduler, SchedulerAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Scheduler | SchedulerAllocation, context: Context) -> Iterator[str]:
    if isinstance(element, Scheduler) and element not in context.once(_responsible):
        yield f"the scheduler {element.name or ''!r} is not responsible for any processing unit"
    if isinstance(element, SchedulerAllocation) and element.scheduler is None:
        yield "the scheduler allocation has no scheduler"


def _responsible(context: Context) -> set[Scheduler | None]:
    return {allocation.scheduler for allocation in context.all(SchedulerAllocation) if allocation.responsibility}


RULE = ModelRule(
    id="INC-MAP-SCHED",
    title="scheduler without a core",
    severity=Severity.WARNING,
    target=(Scheduler, SchedulerAllocation),
    check=_check,
    rationale="am2inc silently creates a scheduler without a core.",
    remedy="Add a scheduler allocation with the scheduler and the processing units for which it is responsible.",
    fails="""
<osModel>
  <operatingSystems name="OS">
    <taskSchedulers name="S"/>
  </operatingSystems>
</osModel>
""",
    passes="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core"/>
  </structures>
</hwModel>
<osModel>
  <operatingSystems name="OS">
    <taskSchedulers name="S"/>
  </operatingSystems>
</osModel>
<mappingModel>
  <schedulerAllocation scheduler="S?type=TaskScheduler" responsibility="core?type=ProcessingUnit"/>
</mappingModel>
""",
)
