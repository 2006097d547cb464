"""Chain that starts or ends with several events."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import EventChain, EventSet
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: EventChain, context: Context) -> Iterator[str]:
    for event in (element.stimulus, element.response):
        if isinstance(event, EventSet) and len(event.events) > 1:
            yield f"the chain {element.name!r} starts or ends with the {len(event.events)} events of {event.name!r}"


RULE = ModelRule(
    id="INC-EC-SET",
    title="chain that starts or ends with several events",
    severity=Severity.WARNING,
    target=EventChain,
    check=_check,
    rationale="The chain is dropped, with a warning.",
    remedy="Start and end it with one event.",
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
