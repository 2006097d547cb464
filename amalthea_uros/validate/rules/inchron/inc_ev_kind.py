"""Unsupported class of event."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import AbstractEventChain, Event, EventSet
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._chains import CONVERTED, events_read


def _check(element: Event | AbstractEventChain, context: Context) -> Iterator[str]:
    if isinstance(element, Event) and not isinstance(element, CONVERTED):
        how = "converted only as part of an event chain" if isinstance(element, EventSet) else "not converted by am2inc"
        yield f"the {type(element).__name__} {element.name or ''!r} is {how}"
    for event in events_read(element) if isinstance(element, AbstractEventChain) else ():
        if not isinstance(event, CONVERTED):
            cause = f"the {type(event).__name__} {event.name or ''!r}"
            yield f"the event chain {element.name or ''!r} is dropped by am2inc because of {cause}"


RULE = ModelRule(
    id="INC-EV-KIND",
    title="unsupported class of event",
    severity=Severity.WARNING,
    target=(Event, AbstractEventChain),
    check=_check,
    rationale="am2inc converts only events of processes, runnables and labels. It drops every event chain that uses another "
    "event, and prints a warning.",
    remedy="Use process, runnable or label events.",
    fails="""
<eventModel>
  <events xsi:type="am:CustomEvent" name="c"/>
</eventModel>
<constraintsModel>
  <eventChains name="C" stimulus="c?type=CustomEvent" response="c?type=CustomEvent"/>
</constraintsModel>
""",
    edits={
        'xsi:type="am:CustomEvent" name="c"/>': """xsi:type="am:ProcessEvent" name="a" entity="T?type=Task" eventType="start"/>
  <events xsi:type="am:ProcessEvent" name="b" entity="T?type=Task" eventType="terminate"/>""",
        "<constraintsModel>": """<swModel>
  <tasks name="T"/>
</swModel>
<constraintsModel>""",
        'stimulus="c?type=CustomEvent" response="c?type=CustomEvent"': 'stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"',
    },
)
