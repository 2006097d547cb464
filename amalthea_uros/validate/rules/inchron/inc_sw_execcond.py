"""Runnable with a condition."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Runnable
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Runnable, context: Context) -> Iterator[str]:
    if element.execution_condition is not None:
        yield f"the condition of {element.name!r} is ignored"


RULE = ModelRule(
    id="INC-SW-EXECCOND",
    title="runnable with a condition",
    severity=Severity.WARNING,
    target=Runnable,
    check=_check,
    rationale="am2inc does not attach the condition, without a word; the runnable is always executed.",
    remedy="Put a switch around the call.",
    fails="""
<swModel>
  <runnables name="R">
    <executionCondition/>
  </runnables>
</swModel>
""",
    passes="""
<swModel>
  <runnables name="R"/>
</swModel>
""",
)
