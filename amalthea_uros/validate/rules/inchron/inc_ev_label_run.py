"""Event of one runnable or core alone."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import LabelEvent, ProcessEvent, RunnableEvent
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: LabelEvent | ProcessEvent | RunnableEvent, context: Context) -> Iterator[str]:
    if isinstance(element, LabelEvent) and element.runnable is not None:
        yield f"the event {element.name!r} holds for all runnables, not for {element.runnable.name!r} alone"
    if isinstance(element, ProcessEvent | RunnableEvent) and element.processing_unit is not None:
        yield f"the event {element.name!r} holds on all cores, not on {element.processing_unit.name!r} alone"


RULE = ModelRule(
    id="INC-EV-LABEL-RUN",
    title="event of one runnable or core alone",
    severity=Severity.WARNING,
    target=(LabelEvent, ProcessEvent, RunnableEvent),
    check=_check,
    rationale="am2inc drops this restriction without a word; that of an event to a process it keeps.",
    remedy="Let the event hold for all, or restrict it to a process.",
    fails="""
<swModel>
  <runnables name="R"/>
  <labels name="L"/>
</swModel>
<eventModel>
  <events xsi:type="am:LabelEvent" name="e" entity="L?type=Label" eventType="read" runnable="R?type=Runnable"/>
</eventModel>
""",
    passes="""
<swModel>
  <labels name="L"/>
</swModel>
<eventModel>
  <events xsi:type="am:LabelEvent" name="e" entity="L?type=Label" eventType="read"/>
</eventModel>
""",
)
