"""Event that is no moment."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import EntityEvent, LabelEvent, ProcessEvent, RunnableEvent, Task
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: EntityEvent, context: Context) -> Iterator[str]:
    if not isinstance(element, ProcessEvent | RunnableEvent | LabelEvent):
        return
    allowed = _allowed(element)
    if element.entity is None or element.event_type not in allowed:
        yield f"the event {element.name!r} names no object, or none of {', '.join(sorted(allowed))}"


def _allowed(event: ProcessEvent | RunnableEvent | LabelEvent) -> set[str]:
    match event:
        case RunnableEvent():
            return {"start", "terminate"}
        case LabelEvent():
            return {"read", "write"}
        case ProcessEvent(entity=Task()):
            return {"activate", "start", "terminate", "resume", "wait", "release"}
    return {"activate", "start", "terminate"}


RULE = ModelRule(
    id="INC-EV-TYPE",
    title="event that is no moment",
    severity=Severity.WARNING,
    target=EntityEvent,
    check=_check,
    rationale="A chain with it is dropped, with a warning.",
    remedy="Name the object, and one of activate, start, terminate; start, terminate of runnables; read, write of labels.",
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
    passes="""
<eventModel>
  <events xsi:type="am:ProcessEvent" name="a" entity="T?type=Task" eventType="start"/>
  <events xsi:type="am:ProcessEvent" name="b" entity="T?type=Task" eventType="terminate"/>
  <events xsi:type="am:CustomEvent" name="c"/>
</eventModel>
<swModel>
  <tasks name="T"/>
</swModel>
""",
)
