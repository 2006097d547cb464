"""Reference to what is not there."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.element import Element, references_of
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._ids import without_namespace


def _check(element: Element, context: Context) -> Iterator[str]:
    found_by_am2inc = context.once(_plain_names)
    for name, value in references_of(element):
        for target in value if isinstance(value, list) else (value,):
            if target.unresolved is not None and target.unresolved not in found_by_am2inc:
                yield f"{features_of(type(element))[name].xml_name!r} refers to {target.unresolved!r}, which is not there"


def _plain_names(context: Context) -> frozenset[str]:
    return frozenset(context.once(without_namespace).values())


RULE = ModelRule(
    id="INC-IO-REF",
    title="reference to what is not there",
    severity=Severity.ERROR,
    target=Element,
    check=_check,
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
