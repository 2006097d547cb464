"""Task without a priority."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import TaskAllocation
from amalthea_uros.timing.scheduling.ranks import is_by_priority
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.scheduling import deciding, policy, priority


def _check(element: TaskAllocation, context: Context) -> Iterator[str]:
    if element.task is not None and is_by_priority(policy(deciding(element.scheduler))) and priority(element) is None:
        yield f"task {element.task.name!r} has no priority"


RULE = ModelRule(
    id="TIM-PRIORITY",
    title="task without a priority",
    severity=Severity.WARNING,
    target=TaskAllocation,
    check=_check,
    rationale="The scheduling order of the task is unknown.",
    remedy="Add the scheduling parameter 'priority' to the task allocation.",
    fails="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core" frequencyDomain="clock?type=FrequencyDomain"/>
  </structures>
</hwModel>
<osModel>
  <schedulingParameterDefinitions name="priority"/>
  <schedulerDefinitions name="FixedPriorityPreemptive"/>
  <operatingSystems name="OS">
    <taskSchedulers name="S" definition="FixedPriorityPreemptive?type=SchedulerDefinition"/>
  </operatingSystems>
</osModel>
<swModel>
  <tasks name="T"/>
</swModel>
<mappingModel>
  <schedulerAllocation scheduler="S?type=TaskScheduler" responsibility="core?type=ProcessingUnit"/>
  <taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler"/>
</mappingModel>
""",
    edits={
        'scheduler="S?type=TaskScheduler"/>': """scheduler="S?type=TaskScheduler">
    <schedulingParameters key="priority?type=SchedulingParameterDefinition">
      <value xsi:type="am:IntegerObject" value="1"/>
    </schedulingParameters>
  </taskAllocation>""",
    },
)
