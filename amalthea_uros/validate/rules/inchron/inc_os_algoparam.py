"""Ignored scheduling parameter."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import SchedulingParameter, TaskAllocation, TaskScheduler
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule

#: The parameters that am2inc reads, by the class of their holder.
_READ = {TaskAllocation: ("priority", "deadline"), TaskScheduler: ("priority",)}


def _check(element: SchedulingParameter, context: Context) -> Iterator[str]:
    holder = type(element.container)
    name = element.key.name if element.key is not None else ""
    if name not in _READ.get(holder, ()) and (name or holder is not TaskScheduler):
        yield f"the scheduling parameter {name!r} of the {holder.__name__} is ignored by am2inc"


RULE = ModelRule(
    id="INC-OS-ALGOPARAM",
    title="ignored scheduling parameter",
    severity=Severity.WARNING,
    target=SchedulingParameter,
    check=_check,
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
)
