"""Unsupported event type."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import AbstractEventChain, Event
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._chains import CONVERTED, events_read, is_converted, moments


def _check(element: Event | AbstractEventChain, context: Context) -> Iterator[str]:
    if isinstance(element, CONVERTED):
        if element.entity is None:
            yield f"the event {element.name or ''!r} has no entity"
        elif element.event_type not in moments(element):
            yield f"the type of the event {element.name or ''!r} is not one of {', '.join(sorted(moments(element)))}"
    for event in events_read(element) if isinstance(element, AbstractEventChain) else ():
        if isinstance(event, CONVERTED) and not is_converted(event):
            yield f"the event chain {element.name or ''!r} is dropped by am2inc because of the event {event.name or ''!r}"


RULE = ModelRule(
    id="INC-EV-TYPE",
    title="unsupported event type",
    severity=Severity.WARNING,
    target=(*CONVERTED, AbstractEventChain),
    check=_check,
    rationale="am2inc does not convert the event. It drops every event chain that uses it and prints a warning.",
    remedy="Set the entity and a supported type: activate, start or terminate for processes (for tasks also resume, wait or "
    "release), start or terminate for runnables, read or write for labels.",
    fails="""
<eventModel>
  <events xsi:type="am:ProcessEvent" name="a" entity="T?type=Task" eventType="preempt"/>
  <events xsi:type="am:ProcessEvent" name="b" entity="T?type=Task" eventType="terminate"/>
  <events xsi:type="am:CustomEvent" name="c"/>
</eventModel>
<swModel>
  <tasks name="T"/>
</swModel>
""",
    edits={'eventType="preempt"': 'eventType="start"'},
)
