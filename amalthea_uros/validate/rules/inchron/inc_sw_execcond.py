"""Runnable with an execution condition."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Runnable
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Runnable, context: Context) -> Iterator[str]:
    if element.execution_condition is not None:
        yield f"the execution condition of the runnable {element.name or ''!r} is ignored by am2inc"


RULE = ModelRule(
    id="INC-SW-EXECCOND",
    title="runnable with an execution condition",
    severity=Severity.WARNING,
    target=Runnable,
    check=_check,
    rationale="am2inc silently leaves the condition unattached, so the runnable is always executed.",
    remedy="Put the call of the runnable into a switch with this condition.",
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
