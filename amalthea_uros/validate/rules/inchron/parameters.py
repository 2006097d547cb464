"""Parameters of schedulers and allocations."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import IntegerObject, SchedulingParameter, TaskAllocation, TaskScheduler, Time
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule

#: The parameters that am2inc reads, by the class of their holder.
_READ = {TaskAllocation: ("priority", "deadline"), TaskScheduler: ("priority",)}


def _check_unread(element: SchedulingParameter, context: Context) -> Iterator[str]:
    holder = type(element.container)
    name = element.key.name if element.key is not None else ""
    if name not in _READ.get(holder, ()) and (name or holder is not TaskScheduler):
        yield f"the scheduling parameter {name!r} of the {holder.__name__} is ignored by am2inc"


def _check_deadline(element: SchedulingParameter, context: Context) -> Iterator[str]:
    is_deadline = element.key is not None and element.key.name == "deadline"
    if is_deadline and isinstance(element.container, TaskAllocation) and not isinstance(element.value, Time):
        yield "the value of the parameter 'deadline' is not a Time"


def _check_priority(element: SchedulingParameter, context: Context) -> Iterator[str]:
    is_priority = element.key is not None and element.key.name == "priority"
    is_read = isinstance(element.container, TaskAllocation | TaskScheduler)
    if is_priority and is_read and not isinstance(element.value, IntegerObject):
        yield "the value of the parameter 'priority' is not an IntegerObject"


RULES = (
    ModelRule(
        id="INC-OS-ALGOPARAM",
        title="ignored scheduling parameter",
        severity=Severity.WARNING,
        target=SchedulingParameter,
        check=_check_unread,
        rationale="am2inc reads priority and deadline of task allocations and priority of task schedulers. It silently ignores "
        "all other parameters, also those with a different spelling.",
        remedy="Use only priority, and deadline for task allocations, in lower case.",
        fails="""
<osModel>
  <schedulingParameterDefinitions name="taskGroup"/>
</osModel>
<swModel>
  <tasks name="T"/>
</swModel>
<mappingModel>
  <taskAllocation task="T?type=Task">
    <schedulingParameters key="taskGroup?type=SchedulingParameterDefinition">
      <value xsi:type="am:IntegerObject" value="3"/>
    </schedulingParameters>
  </taskAllocation>
</mappingModel>
""",
        edits={
            'name="taskGroup"': 'name="priority"',
            'key="taskGroup?type=SchedulingParameterDefinition"': 'key="priority?type=SchedulingParameterDefinition"',
        },
    ),
    ModelRule(
        id="INC-OS-DEADLINE-TYPE",
        title="deadline with a value of the wrong type",
        severity=Severity.WARNING,
        target=SchedulingParameter,
        check=_check_deadline,
        rationale="am2inc silently uses a deadline of 0.",
        remedy="Change the value to a Time, e.g. 10 ms.",
        fails="""
<osModel>
  <schedulingParameterDefinitions name="deadline"/>
</osModel>
<swModel>
  <tasks name="T"/>
</swModel>
<mappingModel>
  <taskAllocation task="T?type=Task">
    <schedulingParameters key="deadline?type=SchedulingParameterDefinition">
      <value xsi:type="am:IntegerObject" value="3"/>
    </schedulingParameters>
  </taskAllocation>
</mappingModel>
""",
        edits={'xsi:type="am:IntegerObject" value="3"': 'xsi:type="am:Time" value="3" unit="ms"'},
    ),
    ModelRule(
        id="INC-OS-PRIO-TYPE",
        title="priority with a value of the wrong type",
        severity=Severity.ERROR,
        target=SchedulingParameter,
        check=_check_priority,
        rationale="am2inc crashes with a segmentation fault.",
        remedy="Change the value to an IntegerObject.",
        fails="""
<osModel>
  <schedulingParameterDefinitions name="priority"/>
</osModel>
<swModel>
  <tasks name="T"/>
</swModel>
<mappingModel>
  <taskAllocation task="T?type=Task">
    <schedulingParameters key="priority?type=SchedulingParameterDefinition">
      <value xsi:type="am:StringObject" value="3"/>
    </schedulingParameters>
  </taskAllocation>
</mappingModel>
""",
        edits={'xsi:type="am:StringObject"': 'xsi:type="am:IntegerObject"'},
    ),
)
