"""Priority with a value of the wrong type."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import IntegerObject, SchedulingParameter, TaskAllocation, TaskScheduler
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: SchedulingParameter, context: Context) -> Iterator[str]:
    is_priority = element.key is not None and element.key.name == "priority"
    is_read = isinstance(element.container, TaskAllocation | TaskScheduler)
    if is_priority and is_read and not isinstance(element.value, IntegerObject):
        yield "the value of the parameter 'priority' is not an IntegerObject"


RULE = ModelRule(
    id="INC-OS-PRIO-TYPE",
    title="priority with a value of the wrong type",
    severity=Severity.ERROR,
    target=SchedulingParameter,
    check=_check,
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
)
