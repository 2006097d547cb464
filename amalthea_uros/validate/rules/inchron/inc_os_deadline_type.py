"""Deadline with a value of the wrong type."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import SchedulingParameter, TaskAllocation, Time
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: SchedulingParameter, context: Context) -> Iterator[str]:
    is_deadline = element.key is not None and element.key.name == "deadline"
    if is_deadline and isinstance(element.container, TaskAllocation) and not isinstance(element.value, Time):
        yield "the value of the parameter 'deadline' is not a Time"


RULE = ModelRule(
    id="INC-OS-DEADLINE-TYPE",
    title="deadline with a value of the wrong type",
    severity=Severity.WARNING,
    target=SchedulingParameter,
    check=_check,
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
)
