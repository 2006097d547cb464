"""Runnable that nothing calls."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Runnable, RunnableCall
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Runnable, context: Context) -> Iterator[str]:
    if not context.uses(RunnableCall, "runnable")[element]:
        yield f"nothing calls the runnable {element.name!r}"


RULE = ModelRule(
    id="TIM-UNREACHABLE",
    title="runnable that nothing calls",
    severity=Severity.INFO,
    target=Runnable,
    check=_check,
    rationale="It never runs; if it should, its time is missing in the load.",
    remedy="Call it from a task, or remove it.",
    fails="""
<swModel>
  <runnables name="R"/>
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
)
