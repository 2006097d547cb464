"""Event restricted to a runnable or core."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import LabelEvent, ProcessEvent, RunnableEvent
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: LabelEvent | ProcessEvent | RunnableEvent, context: Context) -> Iterator[str]:
    if isinstance(element, LabelEvent):
        restriction = None if element.runnable is None else f"the runnable {element.runnable.name or ''!r}"
    else:
        restriction = None if element.processing_unit is None else f"the core {element.processing_unit.name or ''!r}"
    if restriction is not None:
        yield f"the restriction of the event {element.name or ''!r} to {restriction} is dropped by am2inc"


RULE = ModelRule(
    id="INC-EV-LABEL-RUN",
    title="event restricted to a runnable or core",
    severity=Severity.WARNING,
    target=(LabelEvent, ProcessEvent, RunnableEvent),
    check=_check,
    rationale="am2inc silently drops the restriction, so the event applies to all runnables and all cores. It keeps only a "
    "restriction to a process.",
    remedy="Remove the restriction, or restrict the event to a process instead.",
    fails="""
<swModel>
  <runnables name="R"/>
  <labels name="L"/>
</swModel>
<eventModel>
  <events xsi:type="am:LabelEvent" name="e" entity="L?type=Label" eventType="read" runnable="R?type=Runnable"/>
</eventModel>
""",
    edits={
        '  <runnables name="R"/>\n': "",
        'eventType="read" runnable="R?type=Runnable"': 'eventType="read"',
    },
)
