"""Negative counter offset."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Counter
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Counter, context: Context) -> Iterator[str]:
    if (element.offset or 0) < 0:
        yield f"the counter offset is {element.offset}, but must be 0 or more"


RULE = ModelRule(
    id="AM-Basic-Counter",
    title="negative counter offset",
    severity=Severity.ERROR,
    target=Counter,
    check=_check,
    rationale="A counter cannot take effect before the first occurrence. APP4MC's validation also reports it.",
    remedy="Set the offset to 0 or more.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:RunnableCall">
        <counter prescaler="2" offset="-1"/>
      </items>
    </activityGraph>
  </runnables>
</swModel>
""",
    edits={'offset="-1"': 'offset="1"'},
)
