"""Scheduling parameter that is ignored."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import SchedulingParameter, TaskAllocation, TaskScheduler
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule

#: The parameters that are read, by the class of what holds them.
_READ = {TaskAllocation: ("priority", "deadline"), TaskScheduler: ("priority",)}


def _check(element: SchedulingParameter, context: Context) -> Iterator[str]:
    holder = type(element.container)
    name = element.key.name if element.key is not None else ""
    if name not in _READ.get(holder, ()) and (name or holder is not TaskScheduler):
        yield f"the scheduling parameter {name!r} of a {holder.__name__} is ignored"


RULE = ModelRule(
    id="INC-OS-ALGOPARAM",
    title="scheduling parameter that is ignored",
    severity=Severity.WARNING,
    target=SchedulingParameter,
    check=_check,
    rationale="am2inc reads only priority and deadline of task allocations, and priority of schedulers; names are compared exactly.",
    remedy="Rely on these parameters only.",
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
    passes="""
<osModel>
  <schedulingParameterDefinitions name="priority"/>
</osModel>
<swModel>
  <tasks name="T"/>
</swModel>
<mappingModel>
  <taskAllocation task="T?type=Task">
    <schedulingParameters key="priority?type=SchedulingParameterDefinition">
      <value xsi:type="am:IntegerObject" value="3"/>
    </schedulingParameters>
  </taskAllocation>
</mappingModel>
""",
)
