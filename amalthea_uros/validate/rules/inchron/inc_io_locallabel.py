"""Local labels."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Runnable, Task
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Element, context: Context) -> Iterator[str]:
    if isinstance(element, Task | Runnable) and element.local_labels:
        yield f"the local labels of {element.name!r} are dropped"


RULE = ModelRule(
    id="INC-IO-LOCALLABEL",
    title="local labels",
    severity=Severity.WARNING,
    target=Element,
    check=_check,
    rationale="am2inc drops them, with a warning.",
    remedy="Use mode labels of the model.",
    fails="""
<swModel>
  <tasks name="T">
    <localLabels name="l"/>
  </tasks>
</swModel>
""",
    passes="""
<swModel>
  <tasks name="T"/>
</swModel>
""",
)
