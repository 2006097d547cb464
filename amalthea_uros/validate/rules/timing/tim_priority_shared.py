"""Tasks of the same priority."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ProcessingUnit, Scheduler, Task, TaskAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.scheduling import cores, deciding, is_by_priority, policy, priority
from amalthea_uros.validate.wording import listed

#: Scheduler, processing units and priority.
_Place = tuple[Scheduler, frozenset[ProcessingUnit], int]


def _check(element: TaskAllocation, context: Context) -> Iterator[str]:
    place = _place(element, context)
    tasks = context.once(_by_place).get(place, []) if place is not None else []
    others = [task for task in tasks if task is not element.task]
    if element.task is not None and place is not None and others:
        have = "has" if len(others) == 1 else "have"
        yield f"{element.task.name!r} has the priority {place[-1]}, as {listed(others)} {have}"


def _by_place(context: Context) -> dict[_Place, list[Task]]:
    found: dict[_Place, dict[Task, None]] = {}
    for allocation in context.all(TaskAllocation):
        place = _place(allocation, context)
        if place is not None and allocation.task is not None:
            found.setdefault(place, {})[allocation.task] = None
    return {place: list(tasks) for place, tasks in found.items()}


def _place(allocation: TaskAllocation, context: Context) -> _Place | None:
    """Where and with what priority a task is served, if others of the same priority have to wait for it."""
    scheduler, own = deciding(allocation.scheduler), priority(allocation)
    # Under round robin it is meant that tasks share a priority.
    if scheduler is None or own is None or not is_by_priority(scheduler) or policy(scheduler) == "PriorityBasedRoundRobin":
        return None
    units = cores(context).get(allocation.task, frozenset()) if allocation.task is not None else frozenset()
    return scheduler, units, own


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
