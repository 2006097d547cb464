"""Server call of a runnable to itself."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Runnable, ServerCall
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: ServerCall, context: Context) -> Iterator[str]:
    caller = element.enclosing(Runnable)
    if caller is not None and element.server_runnable is caller:
        yield f"{caller.name!r} calls itself as a server"


RULE = ModelRule(
    id="TA-Software-ServerCall",
    title="server call of a runnable to itself",
    severity=Severity.ERROR,
    target=ServerCall,
    check=_check,
    rationale="A synchronous call waits for itself forever, and an asynchronous call is repeated forever. APP4MC's validation "
    "also reports it.",
    remedy="Remove the call, or call another runnable.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:SynchronousServerCall" serverRunnable="R?type=Runnable"/>
    </activityGraph>
  </runnables>
</swModel>
""",
    edits={
        'serverRunnable="R?type=Runnable"': 'serverRunnable="Q?type=Runnable"',
        "</swModel>": """  <runnables name="Q"/>
</swModel>""",
    },
)
