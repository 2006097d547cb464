"""Argument that is not for the called runnable."""

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
        yield "the argument names no parameter"
    if called is None:
        yield "the argument belongs to a call of no runnable"
    elif parameter is not None and None is called.unresolved is parameter.unresolved and parameter.container is not called:
        yield f"{parameter.qualified_name!r} is no parameter of {called.qualified_name!r}, which is called"


RULE = ModelRule(
    id="AM-SW-CallArgument",
    title="argument that is not for the called runnable",
    severity=Severity.ERROR,
    target=CallArgument,
    check=_check,
    rationale="It is not known what receives the value. APP4MC reports it when it validates the model.",
    remedy="Name a parameter of the runnable that is called.",
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
    passes="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:RunnableCall" runnable="S?type=Runnable">
        <arguments parameter="S/p?type=RunnableParameter"/>
      </items>
    </activityGraph>
  </runnables>
  <runnables name="S">
    <parameters name="p" direction="in"/>
  </runnables>
</swModel>
""",
)
