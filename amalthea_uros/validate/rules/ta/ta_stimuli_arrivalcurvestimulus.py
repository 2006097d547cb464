"""Waiting for an event that is never set."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import EventMask, OsEvent, SetEvent, WaitEvent
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: OsEvent, context: Context) -> Iterator[str]:
    # APP4MC uses this id for the rule, although it names another subject.
    if element in context.once(_awaited) and element not in context.once(_set):
        yield f"{element.name!r} is waited for, but never set"


def _awaited(context: Context) -> set[OsEvent]:
    return _in_masks(item.event_mask for item in context.all(WaitEvent))


def _set(context: Context) -> set[OsEvent]:
    return _in_masks(item.event_mask for item in context.all(SetEvent))


def _in_masks(masks: Iterable[EventMask | None]) -> set[OsEvent]:
    return {event for mask in masks if mask is not None for event in mask.events}


RULE = ModelRule(
    id="TA-Stimuli-ArrivalCurveStimulus",
    title="waiting for an event that is never set",
    severity=Severity.ERROR,
    target=OsEvent,
    check=_check,
    rationale="A process that waits for the event is blocked forever. APP4MC's validation also reports it.",
    remedy="Set the event in another process, or do not wait for it.",
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
    edits={
        '<events name="E"/>': """<tasks name="U">
    <activityGraph>
      <items xsi:type="am:SetEvent">
        <eventMask events="E?type=OsEvent"/>
      </items>
    </activityGraph>
  </tasks>
  <events name="E"/>""",
    },
)
