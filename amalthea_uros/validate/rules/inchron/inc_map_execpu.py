"""Scheduler executed by another core."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import SchedulerAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: SchedulerAllocation, context: Context) -> Iterator[str]:
    core = element.executing_pu
    if core is not None and core not in element.responsibility:
        name = element.scheduler.name if element.scheduler is not None else None
        yield f"the executing processing unit {core.name or ''!r} of the scheduler {name or ''!r} is ignored by am2inc"


RULE = ModelRule(
    id="INC-MAP-EXECPU",
    title="scheduler executed by another core",
    severity=Severity.INFO,
    target=SchedulerAllocation,
    check=_check,
    rationale="am2inc ignores the core that executes a scheduler. It reads only the cores for which the scheduler is "
    "responsible.",
    remedy="Remove the executing processing unit, or do not rely on it after the import.",
    fails="""
<hwModel>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core"/>
  </structures>
</hwModel>
<mappingModel>
  <schedulerAllocation executingPU="core?type=ProcessingUnit"/>
</mappingModel>
""",
    edits={
        'executingPU="core?type=ProcessingUnit"': 'responsibility="core?type=ProcessingUnit" executingPU="core?type=ProcessingUnit"',
    },
)
