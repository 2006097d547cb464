"""Scheduling parameter other than priority and deadline."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import SchedulingParameter
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: SchedulingParameter, context: Context) -> Iterator[str]:
    if element.key is not None and element.key.name not in ("priority", "deadline"):
        yield f"the scheduling parameter {element.key.name!r} is ignored"


RULE = ModelRule(
    id="INC-OS-ALGOPARAM",
    title="scheduling parameter other than priority and deadline",
    severity=Severity.WARNING,
    target=SchedulingParameter,
    check=_check,
    rationale="am2inc ignores it without a word; names are compared exactly.",
    remedy="Rely on priority and deadline only.",
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
