"""Unresolved reference."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, ModelRule
from amalthea_uros.validate.rules.inchron._importer import without_namespace
from amalthea_uros.validate.rules.inchron.missing_references import is_needed


def _check(element: Element, context: Context) -> Iterator[str | Downgraded]:
    for name, text in context.dangling.get(element, ()):
        if text not in context.once(_plain_names):
            message = f"the reference {name!r} to {text!r} cannot be resolved"
            yield message if is_needed(element, name) else Downgraded(message)


def _plain_names(context: Context) -> frozenset[str]:
    return frozenset(context.once(without_namespace).values())


RULE = ModelRule(
    id="INC-IO-REF",
    title="unresolved reference",
    severity=Severity.ERROR,
    target=Element,
    check=_check,
    among=lambda context: context.dangling,
    rationale="am2inc prints a message and continues without the object. It crashes with a segmentation fault if the object is a "
    "called runnable, an accessed or mapped label, a stimulus, an allocated task, a frequency domain, or an end of an event chain. "
    "Other references are lost (warning).",
    remedy="Correct the reference, or pass all files of the model to am2inc.",
    fails="""
<swModel>
  <tasks name="T">
    <activityGraph>
      <items xsi:type="am:RunnableCall" runnable="R?type=Runnable"/>
    </activityGraph>
  </tasks>
</swModel>
""",
    edits={
        "</swModel>": """  <runnables name="R"/>
</swModel>""",
    },
    is_about_files=True,
)
