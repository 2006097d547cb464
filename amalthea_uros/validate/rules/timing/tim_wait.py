"""Waiting without a bound."""

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
    yield f"nothing says how long it waits{what} at most"


RULE = ModelRule(
    id="TIM-WAIT",
    title="waiting without a bound",
    severity=Severity.WARNING,
    target=WaitEvent,
    check=_check,
    rationale="The process has no worst case, so that its response time is not known, nor are those of the less urgent ones "
    "beside it.",
    remedy="Let what sets the event activate a process of its own instead.",
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
