"""Tasks of the same priority."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import IntegerObject, Scheduler, SchedulingParameter, Task, TaskAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: TaskAllocation, context: Context) -> Iterator[str]:
    priority = _priority(element)
    same = [task for task in context.once(_by_priority).get((element.scheduler, priority), []) if task is not element.task]
    if same and element.task is not None and priority is not None:
        yield f"{element.task.name!r} has the priority {priority}, as {', '.join(repr(task.name) for task in same)} have"


def _by_priority(context: Context) -> dict[tuple[Scheduler | None, int | None], list[Task]]:
    found: dict[tuple[Scheduler | None, int | None], list[Task]] = {}
    for allocation in context.all(TaskAllocation):
        if allocation.task is not None:
            found.setdefault((allocation.scheduler, _priority(allocation)), []).append(allocation.task)
    return found


def _priority(allocation: TaskAllocation) -> int | None:
    for parameter in allocation.scheduling_parameters:
        if isinstance(parameter, SchedulingParameter) and parameter.key is not None and parameter.key.name == "priority":
            return parameter.value.value if isinstance(parameter.value, IntegerObject) else None
    return None


RULE = ModelRule(
    id="TIM-PRIORITY-SHARED",
    title="tasks of the same priority",
    severity=Severity.INFO,
    target=TaskAllocation,
    check=_check,
    rationale="They are served in the order of their arrival; an analysis has to take each for being first.",
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
    passes="""
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
      <value xsi:type="am:IntegerObject" value="2"/>
    </schedulingParameters>
  </taskAllocation>
</mappingModel>
""",
)
