"""Scheduling parameter without a key."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import SchedulingParameter, TaskScheduler
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: SchedulingParameter, context: Context) -> Iterator[str]:
    if element.key is None and isinstance(element.container, TaskScheduler):
        yield f"a scheduling parameter of the scheduler {element.container.name or ''!r} has no key"


RULE = ModelRule(
    id="INC-OS-PARAM-KEY",
    title="scheduling parameter without a key",
    severity=Severity.ERROR,
    target=SchedulingParameter,
    check=_check,
    rationale="am2inc crashes with a segmentation fault.",
    remedy="Set the key to the definition of the parameter.",
    fails="""
<osModel>
  <operatingSystems name="OS">
    <taskSchedulers name="S">
      <schedulingParameters>
        <value xsi:type="am:IntegerObject" value="3"/>
      </schedulingParameters>
    </taskSchedulers>
  </operatingSystems>
</osModel>
""",
    edits={
        "<schedulingParameters": '<schedulingParameters key="priority?type=SchedulingParameterDefinition"',
        "</osModel>": """  <schedulingParameterDefinitions name="priority"/>
</osModel>""",
    },
)
