"""Scheduling parameter without a key."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import SchedulingParameter
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: SchedulingParameter, context: Context) -> Iterator[str]:
    if element.key is None:
        yield "the scheduling parameter has no key"


RULE = ModelRule(
    id="INC-OS-PARAM-KEY",
    title="scheduling parameter without a key",
    severity=Severity.ERROR,
    target=SchedulingParameter,
    check=_check,
    rationale="am2inc ends with a segmentation fault.",
    remedy="Let the parameter refer to its definition.",
    fails="""
<swModel>
  <tasks name="T"/>
</swModel>
<mappingModel>
  <taskAllocation task="T?type=Task">
    <schedulingParameters>
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
