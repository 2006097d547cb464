"""Dependency of data that cannot be."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    CallArgument,
    DataDependency,
    DirectionType,
    LabelAccess,
    LabelAccessEnum,
    Runnable,
    RunnableParameter,
)
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule

#: Directions of parameters that bring data into a runnable, and out of it.
_IN = (DirectionType.IN, DirectionType.INOUT)
_OUT = (DirectionType.OUT, DirectionType.INOUT)


def _check(element: DataDependency, context: Context) -> Iterator[str]:
    runnable = element.enclosing(Runnable)
    if runnable is None:
        return
    yield from _of_owner(element.container)
    for parameter in element.parameters:
        if parameter.unresolved is None and not (parameter.container is runnable and parameter.direction in _IN):
            yield f"{parameter.qualified_name!r} is no parameter that brings data into {runnable.qualified_name!r}"
    for argument in element.call_arguments:
        if argument.unresolved is None and not (argument.enclosing(Runnable) is runnable and _has_result(argument)):
            yield f"{argument.qualified_name!r} is not the result of a call in {runnable.qualified_name!r}"


def _of_owner(owner: Element | None) -> Iterator[str]:
    match owner:
        case LabelAccess() if owner.access != LabelAccessEnum.WRITE:
            yield "an access that does not write depends on data"
        case RunnableParameter() if owner.direction not in _OUT:
            yield f"the parameter {owner.name!r}, which brings no data out of the runnable, depends on data"
        case CallArgument(parameter=RunnableParameter(unresolved=None) as parameter) if parameter.direction not in _IN:
            yield f"the argument for {parameter.qualified_name!r}, which brings no data into the called runnable, depends on data"


def _has_result(argument: CallArgument) -> bool:
    parameter = argument.parameter
    return parameter is not None and (parameter.unresolved is not None or parameter.direction in _OUT)


RULE = ModelRule(
    id="AM-SW-DataDependency",
    title="dependency of data that cannot be",
    severity=Severity.ERROR,
    target=DataDependency,
    check=_check,
    rationale="Only what is written depends on data, and only on what has come into the runnable. "
    "APP4MC reports it when it validates the model.",
    remedy="State dependencies of written labels, outgoing parameters and passed arguments, on parameters and results that come in.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:LabelAccess" access="read" data="L?type=Label">
        <dependsOn parameters="R/p?type=RunnableParameter"/>
      </items>
    </activityGraph>
    <parameters name="p" direction="in"/>
  </runnables>
  <labels name="L"/>
</swModel>
""",
    passes="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:LabelAccess" access="write" data="L?type=Label">
        <dependsOn parameters="R/p?type=RunnableParameter"/>
      </items>
    </activityGraph>
    <parameters name="p" direction="in"/>
  </runnables>
  <labels name="L"/>
</swModel>
""",
)
