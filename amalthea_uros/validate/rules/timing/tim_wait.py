"""Unbounded waiting time."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import WaitEvent
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.wording import listed


def _check(element: WaitEvent, context: Context) -> Iterator[str]:
    events = element.event_mask.events if element.event_mask is not None else []
    what = f" for {listed(events)}" if events else ""
    yield f"the maximum waiting time{what} is unknown"


RULE = ModelRule(
    id="TIM-WAIT",
    title="unbounded waiting time",
    severity=Severity.WARNING,
    target=WaitEvent,
    check=_check,
    rationale="The process has no worst case, so its response time is unknown, and so are those of lower-priority processes "
    "on the same core.",
    remedy="Trigger a separate task instead of waiting for the event.",
    fails="""
<swModel>
  <tasks name="T">
    <activityGraph>
      <items xsi:type="am:WaitEvent">
        <eventMask events="E?type=OsEvent"/>
      </items>
    </activityGraph>
  </tasks>
  <events name="E"/>
</swModel>
""",
    passes="""
<swModel>
  <tasks name="T" stimuli="S?type=InterProcessStimulus"/>
</swModel>
<stimuliModel>
  <stimuli xsi:type="am:InterProcessStimulus" name="S"/>
</stimuliModel>
""",
)
