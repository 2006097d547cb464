"""Tasks of the same priority."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.timing.scheduling.shared_priorities import sharing_a_priority
from amalthea_uros.validate.rule import SystemProblem, SystemRule
from amalthea_uros.validate.system_context import SystemContext
from amalthea_uros.validate.wording import joined


def _check(context: SystemContext) -> Iterator[SystemProblem]:
    for allocation, priority, others in sharing_a_priority(context.system, context.cores):
        have = "has" if len(others) == 1 else "have"
        message = f"{allocation.task!r} has the priority {priority}, as {joined(map(repr, others))} {have}"
        yield SystemProblem(allocation, message, allocation.task)


RULE = SystemRule(
    id="TIM-PRIORITY-SHARED",
    title="tasks of the same priority",
    severity=Severity.INFO,
    check=_check,
    rationale="They are executed in the order of their activation, so that each may have to wait for the others.",
    remedy="Give each task of a scheduler a priority of its own.",
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
  <tasks name="U"/>
</swModel>
<mappingModel>
  <schedulerAllocation scheduler="S?type=TaskScheduler" responsibility="core?type=ProcessingUnit"/>
  <taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler">
    <schedulingParameters key="priority?type=SchedulingParameterDefinition">
      <value xsi:type="am:IntegerObject" value="1"/>
    </schedulingParameters>
  </taskAllocation>
  <taskAllocation task="U?type=Task" scheduler="S?type=TaskScheduler">
    <schedulingParameters key="priority?type=SchedulingParameterDefinition">
      <value xsi:type="am:IntegerObject" value="1"/>
    </schedulingParameters>
  </taskAllocation>
</mappingModel>
""",
    edits={
        """<taskAllocation task="U?type=Task" scheduler="S?type=TaskScheduler">
    <schedulingParameters key="priority?type=SchedulingParameterDefinition">
      <value xsi:type="am:IntegerObject" value="1"/>""": """<taskAllocation task="U?type=Task" scheduler="S?type=TaskScheduler">
    <schedulingParameters key="priority?type=SchedulingParameterDefinition">
      <value xsi:type="am:IntegerObject" value="2"/>""",
    },
)
