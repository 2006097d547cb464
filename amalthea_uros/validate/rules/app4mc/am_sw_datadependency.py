"""Invalid data dependency."""

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

#: Directions of input and output parameters.
_IN = (DirectionType.IN, DirectionType.INOUT)
_OUT = (DirectionType.OUT, DirectionType.INOUT)


def _check(element: DataDependency, context: Context) -> Iterator[str]:
    runnable = element.enclosing(Runnable)
    if runnable is None:
        return
    yield from _of_owner(element.container)
    for parameter in element.parameters:
        if parameter.unresolved is None and not (parameter.container is runnable and parameter.direction in _IN):
            yield f"{parameter.qualified_name!r} is not an input parameter of {runnable.qualified_name!r}"
    for argument in element.call_arguments:
        if argument.unresolved is None and not (argument.enclosing(Runnable) is runnable and _has_result(argument)):
            yield f"{argument.qualified_name!r} is not the result of a call in {runnable.qualified_name!r}"


def _of_owner(owner: Element | None) -> Iterator[str]:
    match owner:
        case LabelAccess() if owner.access != LabelAccessEnum.WRITE:
            yield "a label access that does not write cannot depend on data"
        case RunnableParameter() if owner.direction not in _OUT:
            yield f"parameter {owner.name!r} is not an output parameter and cannot depend on data"
        case CallArgument(parameter=RunnableParameter(unresolved=None) as parameter) if parameter.direction not in _IN:
            yield f"the argument for {parameter.qualified_name!r}, which is not an input parameter, cannot depend on data"


def _has_result(argument: CallArgument) -> bool:
    parameter = argument.parameter
    return parameter is not None and (parameter.unresolved is not None or parameter.direction in _OUT)


RULE = ModelRule(
    id="AM-SW-DataDependency",
    title="invalid data dependency",
    severity=Severity.ERROR,
    target=DataDependency,
    check=_check,
    rationale="Only written data can depend on other data, and only on data that is available in the runnable. APP4MC's "
    "validation also reports it.",
    remedy="Declare dependencies of written labels, output parameters and passed arguments on labels, input parameters and "
    "call results.",
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
    edits={'access="read"': 'access="write"'},
)
