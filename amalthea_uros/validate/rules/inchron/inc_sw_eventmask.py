"""Event mask without exactly one event."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import EventMask
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: EventMask, context: Context) -> Iterator[str]:
    match len(element.events):
        case 0:
            yield "the event mask is empty, so the access has no effect"
        case count if count > 1:
            yield f"only the first of the {count} events in the mask is used by am2inc"


RULE = ModelRule(
    id="INC-SW-EVENTMASK",
    title="event mask without exactly one event",
    severity=Severity.WARNING,
    target=EventMask,
    check=_check,
    rationale="am2inc silently uses only the first event of a mask.",
    remedy="Use exactly one event per mask.",
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
    edits={
        'events="a?type=OsEvent b?type=OsEvent"': 'events="a?type=OsEvent"',
        '  <events name="b"/>\n': "",
    },
)
