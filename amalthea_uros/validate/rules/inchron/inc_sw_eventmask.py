"""Mask of several events."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import EventMask
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: EventMask, context: Context) -> Iterator[str]:
    if len(element.events) != 1:
        yield f"of {len(element.events)} events in the mask at most one is used"


RULE = ModelRule(
    id="INC-SW-EVENTMASK",
    title="mask of several events",
    severity=Severity.WARNING,
    target=EventMask,
    check=_check,
    rationale="Only the first event is used, without a word.",
    remedy="Use one event in each mask.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:SetEvent">
        <eventMask events="a?type=OsEvent b?type=OsEvent"/>
      </items>
    </activityGraph>
  </runnables>
  <events name="a"/>
  <events name="b"/>
</swModel>
""",
    passes="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:SetEvent">
        <eventMask events="a?type=OsEvent"/>
      </items>
    </activityGraph>
  </runnables>
  <events name="a"/>
</swModel>
""",
)
