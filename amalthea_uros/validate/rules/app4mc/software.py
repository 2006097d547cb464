"""Calls, channels, services and modes of the software."""

from __future__ import annotations

import re
from collections.abc import Iterator

from amalthea_uros._internal.plural import counted
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.execution import called
from amalthea_uros.validate.rule import model_rule


@model_rule("AM-SW-CallArgument", am.CallArgument)
def _check_callargument(element: am.CallArgument, context: Context) -> Iterator[str]:
    call, parameter = element.container, element.parameter
    called = call.runnable if isinstance(call, am.RunnableCall) else None
    if parameter is None:
        yield "the argument has no parameter"
    if called is None:
        yield "the argument belongs to a call without a runnable"
    elif parameter is not None and None is called.unresolved is parameter.unresolved and parameter.container is not called:
        yield f"{parameter.qualified_name!r} is not a parameter of the called runnable {called.qualified_name!r}"


#: Directions of input and output parameters.
_IN = (am.DirectionType.IN, am.DirectionType.INOUT)


_OUT = (am.DirectionType.OUT, am.DirectionType.INOUT)


@model_rule("AM-SW-DataDependency", am.DataDependency)
def _check_datadependency(element: am.DataDependency, context: Context) -> Iterator[str]:
    runnable = element.enclosing(am.Runnable)
    if runnable is None:
        return
    yield from _of_owner(element.container)
    for parameter in element.parameters:
        if parameter.unresolved is None and not (parameter.container is runnable and parameter.direction in _IN):
            yield f"{parameter.qualified_name!r} is not an input parameter of {runnable.qualified_name!r}"
    for argument in element.call_arguments:
        if argument.unresolved is None and not (argument.enclosing(am.Runnable) is runnable and _has_result(argument)):
            yield f"{argument.qualified_name!r} is not the result of a call in {runnable.qualified_name!r}"


def _of_owner(owner: Element | None) -> Iterator[str]:
    match owner:
        case am.LabelAccess() if owner.access != am.LabelAccessEnum.WRITE:
            yield "a label access that does not write cannot depend on data"
        case am.RunnableParameter() if owner.direction not in _OUT:
            yield f"parameter {owner.name!r} is not an output parameter and cannot depend on data"
        case am.CallArgument(parameter=am.RunnableParameter(unresolved=None) as parameter) if parameter.direction not in _IN:
            yield f"the argument for {parameter.qualified_name!r}, which is not an input parameter, cannot depend on data"


def _has_result(argument: am.CallArgument) -> bool:
    parameter = argument.parameter
    return parameter is not None and (parameter.unresolved is not None or parameter.direction in _OUT)


@model_rule("DOC-Channel-Fill", am.Channel)
def _check_fill(element: am.Channel, context: Context) -> Iterator[str]:
    most = element.max_elements
    if most is None:
        return
    if (element.default_elements or 0) > most:
        yield f"{element.name!r} starts with {counted(element.default_elements or 0, 'element')}, but can hold at most {most}"
    sent = context.once(_sent).get(element, 0)
    if sent > most:
        yield f"{element.name!r} receives {counted(sent, 'element')} at once, but can hold at most {most}"


def _sent(context: Context) -> dict[am.Channel, int]:
    """The largest number of elements that is sent to each channel at once."""
    found: dict[am.Channel, int] = {}
    for access in context.all(am.ChannelSend):
        if access.data is not None:
            found[access.data] = max(found.get(access.data, 0), access.elements or 0)
    return found


@model_rule("DOC-Channel-LowerBound", am.ChannelReceive)
def _check_lower_bound(element: am.ChannelReceive, context: Context) -> Iterator[str]:
    least, most = element.lower_bound, element.elements
    if least is not None and least < 0:
        yield f"the lower bound {least} is negative"
    if least is not None and most is not None and least > most:
        yield f"the lower bound {least} is above the number of elements {most}"


@model_rule("DOC-Service-Caller", am.Runnable)
def _check_service_caller(element: am.Runnable, context: Context) -> Iterator[str]:
    if element.service:
        for process in context.once(_processes).get(element, {}):
            yield f"service {element.name!r} is called directly by {process.name!r}"


def _processes(context: Context) -> dict[am.Runnable, dict[am.Process, None]]:
    """The processes that call each runnable directly."""
    found: dict[am.Runnable, dict[am.Process, None]] = {}
    for process in context.all(am.Process):
        for runnable in called(process, context):
            found.setdefault(runnable, {})[process] = None
    return found


_INTEGER = re.compile("-?[0-9]+")


@model_rule("DOC-Enum-Initial", am.ModeLabel)
def _check_enum_initial(element: am.ModeLabel, context: Context) -> Iterator[str]:
    value, mode = element.initial_value, element.mode
    if value is None or mode is None or mode.unresolved is not None:
        return
    if isinstance(mode, am.EnumMode) and value.strip() not in context.once(_literals).get(mode, frozenset()):
        yield f"the initial value {value!r} of {element.name!r} is not a literal of {mode.name!r}"
    if isinstance(mode, am.NumericMode) and not _INTEGER.fullmatch(value.strip()):
        yield f"the initial value {value!r} of {element.name!r} is not an integer"


def _literals(context: Context) -> dict[am.EnumMode, frozenset[str | None]]:
    return {mode: frozenset(literal.name for literal in mode.literals) for mode in context.all(am.EnumMode)}
