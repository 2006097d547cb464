"""Scheduler without a core."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Scheduler, SchedulerAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Scheduler, context: Context) -> Iterator[str]:
    if not any(a.scheduler is element and a.responsibility for a in context.all(SchedulerAllocation)):
        yield f"no scheduler allocation makes {element.name!r} responsible for a processing unit"


RULE = ModelRule(
    id="INC-MAP-SCHED",
    title="scheduler without a core",
    severity=Severity.WARNING,
    target=Scheduler,
    check=_check,
    rationale="am2inc makes a scheduler without a core, without a word.",
    remedy="Give it a scheduler allocation with a responsibility.",
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
