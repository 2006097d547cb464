"""Call argument without a matching parameter."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import CallArgument, RunnableCall
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: CallArgument, context: Context) -> Iterator[str]:
    call, parameter = element.container, element.parameter
    called = call.runnable if isinstance(call, RunnableCall) else None
    if parameter is None:
        yield "the argument has no parameter"
    if called is None:
        yield "the argument belongs to a call without a runnable"
    elif parameter is not None and None is called.unresolved is parameter.unresolved and parameter.container is not called:
        yield f"{parameter.qualified_name!r} is not a parameter of the called runnable {called.qualified_name!r}"


RULE = ModelRule(
    id="AM-SW-CallArgument",
    title="call argument without a matching parameter",
    severity=Severity.ERROR,
    target=CallArgument,
    check=_check,
    rationale="The called runnable does not receive the value. APP4MC's validation also reports it.",
    remedy="Refer to a parameter of the called runnable.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:RunnableCall" runnable="S?type=Runnable">
        <arguments/>
      </items>
    </activityGraph>
  </runnables>
  <runnables name="S">
    <parameters name="p" direction="in"/>
  </runnables>
</swModel>
""",
    edits={"<arguments": '<arguments parameter="S/p?type=RunnableParameter"'},
)
