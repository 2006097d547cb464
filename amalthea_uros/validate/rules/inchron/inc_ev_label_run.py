"""Event of a label in one runnable."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import LabelEvent
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: LabelEvent, context: Context) -> Iterator[str]:
    if element.runnable is not None:
        yield f"the event {element.name!r} holds for one runnable only, and is dropped"


RULE = ModelRule(
    id="INC-EV-LABEL-RUN",
    title="event of a label in one runnable",
    severity=Severity.WARNING,
    target=LabelEvent,
    check=_check,
    rationale="It is dropped without a word.",
    remedy="Let the event hold for all runnables.",
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
