"""Local mode label."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import IExecutable
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: IExecutable, context: Context) -> Iterator[str]:
    if element.local_labels:
        yield f"the local mode labels of {name_of(element)!r} are dropped by am2inc"


RULE = ModelRule(
    id="INC-IO-LOCALLABEL",
    title="local mode label",
    severity=Severity.WARNING,
    target=IExecutable,
    check=_check,
    rationale="am2inc drops local mode labels and prints a warning.",
    remedy="Replace them with mode labels of the software model.",
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
