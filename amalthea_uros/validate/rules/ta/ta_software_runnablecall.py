"""Runnable that calls itself at once."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Runnable, RunnableCall
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: RunnableCall, context: Context) -> Iterator[str]:
    caller = element.enclosing(Runnable)
    if caller is not None and element.runnable is caller:
        yield f"{caller.name!r} calls itself"


RULE = ModelRule(
    id="TA-Software-RunnableCall",
    title="runnable that calls itself at once",
    severity=Severity.ERROR,
    target=RunnableCall,
    check=_check,
    rationale="Its execution time has no end. APP4MC reports it when it validates the model.",
    remedy="Call something else, or nothing.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:RunnableCall" runnable="R?type=Runnable"/>
    </activityGraph>
  </runnables>
</swModel>
""",
    passes="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:RunnableCall" runnable="Q?type=Runnable"/>
    </activityGraph>
  </runnables>
  <runnables name="Q"/>
</swModel>
""",
)
