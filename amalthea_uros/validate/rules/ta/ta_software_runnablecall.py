"""Runnable that calls itself directly."""

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
    title="runnable that calls itself directly",
    severity=Severity.ERROR,
    target=RunnableCall,
    check=_check,
    rationale="The execution time of the runnable is unbounded. APP4MC's validation also reports it.",
    remedy="Remove the call, or call another runnable.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:RunnableCall" runnable="R?type=Runnable"/>
    </activityGraph>
  </runnables>
</swModel>
""",
    edits={
        'runnable="R?type=Runnable"': 'runnable="Q?type=Runnable"',
        "</swModel>": """  <runnables name="Q"/>
</swModel>""",
    },
)
