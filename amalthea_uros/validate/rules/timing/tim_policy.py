"""Scheduler without a policy."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import TaskAllocation, TaskScheduler
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.scheduling import policy


def _check(element: TaskScheduler, context: Context) -> Iterator[str]:
    if policy(element) is None and context.uses(TaskAllocation, "scheduler")[element]:
        yield f"scheduler {element.name!r} has tasks, but no policy"


RULE = ModelRule(
    id="TIM-POLICY",
    title="scheduler without a policy",
    severity=Severity.WARNING,
    target=TaskScheduler,
    check=_check,
    rationale="The scheduling order is unknown, so response times are unknown.",
    remedy="Refer to a scheduler definition, such as FixedPriorityPreemptive.",
    fails="""
<osModel>
  <schedulerDefinitions name="FixedPriorityPreemptive"/>
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
    edits={'name="S"/>': 'name="S" definition="FixedPriorityPreemptive?type=SchedulerDefinition"/>'},
)
