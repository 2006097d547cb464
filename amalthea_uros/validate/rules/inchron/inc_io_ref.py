"""Reference to what is not there."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._ids import without_namespace


def _check(element: Element, context: Context) -> Iterator[str]:
    for name, text in context.dangling.get(element, ()):
        if text not in context.once(_plain_names):
            yield f"{name!r} refers to {text!r}, which is not there"


def _plain_names(context: Context) -> frozenset[str]:
    return frozenset(context.once(without_namespace).values())


RULE = ModelRule(
    id="INC-IO-REF",
    title="reference to what is not there",
    severity=Severity.ERROR,
    target=Element,
    check=_check,
    among=lambda context: context.dangling,
    rationale="am2inc writes a line to stderr and goes on without the object, mostly into a segmentation fault.",
    remedy="Correct the reference, or give am2inc all files of the model.",
    fails="""
<swModel>
  <tasks name="T">
    <activityGraph>
      <items xsi:type="am:RunnableCall" runnable="R?type=Runnable"/>
    </activityGraph>
  </tasks>
</swModel>
""",
    passes="""
<swModel>
  <tasks name="T">
    <activityGraph>
      <items xsi:type="am:RunnableCall" runnable="R?type=Runnable"/>
    </activityGraph>
  </tasks>
  <runnables name="R"/>
</swModel>
""",
    is_about_files=True,
)
