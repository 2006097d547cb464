"""Event set as stimulus or response."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import EventChain, EventSet
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: EventChain, context: Context) -> Iterator[str]:
    for end, event in (("stimulus", element.stimulus), ("response", element.response)):
        if isinstance(event, EventSet) and len(event.events) > 1:
            yield f"the {end} of the event chain {element.name!r} is {event.name!r}, a set of {len(event.events)} events"


RULE = ModelRule(
    id="INC-EC-SET",
    title="event set as stimulus or response",
    severity=Severity.WARNING,
    target=EventChain,
    check=_check,
    rationale="am2inc drops event chains that start or end with more than one event and prints a warning.",
    remedy="Use a single event as stimulus and as response.",
    fails="""
<eventModel>
  <events xsi:type="am:ProcessEvent" name="a" entity="T?type=Task" eventType="start"/>
  <events xsi:type="am:ProcessEvent" name="b" entity="T?type=Task" eventType="terminate"/>
  <events xsi:type="am:CustomEvent" name="c"/>
  <events xsi:type="am:EventSet" name="set" events="a?type=ProcessEvent b?type=ProcessEvent"/>
</eventModel>
<swModel>
  <tasks name="T"/>
</swModel>
<constraintsModel>
  <eventChains name="C" stimulus="a?type=ProcessEvent" response="set?type=EventSet"/>
</constraintsModel>
""",
    passes="""
<eventModel>
  <events xsi:type="am:ProcessEvent" name="a" entity="T?type=Task" eventType="start"/>
  <events xsi:type="am:ProcessEvent" name="b" entity="T?type=Task" eventType="terminate"/>
  <events xsi:type="am:CustomEvent" name="c"/>
</eventModel>
<swModel>
  <tasks name="T"/>
</swModel>
<constraintsModel>
  <eventChains name="C" stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>
</constraintsModel>
""",
)
