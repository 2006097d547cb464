"""Items of activity graphs."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import ToolEffect
from amalthea_uros.metamodel import classes as am
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, drops, model_rule
from amalthea_uros.validate.rules.inchron.importer import metamodel


@model_rule("INC-SW-ACCESS", am.LabelAccess, am.ModeLabelAccess, am.SemaphoreAccess)
def _check_access(
    element: am.LabelAccess | am.ModeLabelAccess | am.SemaphoreAccess, context: Context
) -> Iterator[str | Downgraded]:
    match element:
        case am.LabelAccess() if element.access not in ("read", "write"):
            yield "the label access is neither a read nor a write"
        case am.ModeLabelAccess(data=am.ModeLabel(mode=am.EnumMode()) as label) if element.access not in ("read", "set"):
            yield drops(
                f"the access to the mode label {label.name or ''!r} neither reads nor sets a literal and is dropped by am2inc"
            )
        case am.ModeLabelAccess(data=am.ModeLabel() as label, access=None | "_undefined_"):
            yield drops(f"the access to the mode label {label.name or ''!r} has no access type and is dropped by am2inc")
        case am.SemaphoreAccess(semaphore=None):
            yield Downgraded("the semaphore access has no semaphore", effect=ToolEffect.KEEPS)


@model_rule("INC-SW-CONDKIND", am.Condition)
def _check_condkind(element: am.Condition, context: Context) -> Iterator[str | Downgraded]:
    if isinstance(element, am.ModeValueCondition):
        if element.label is None:
            yield "the condition has no mode label"
    elif isinstance(element, am.ModeLabelCondition):
        first, second = element.label1, element.label2
        if first is None or second is None:
            yield "the condition has fewer than two mode labels"
        elif first.unresolved is None and second.unresolved is None and not _is_of_same_kind(first, second):
            yield Downgraded(f"the mode labels {first.name or ''!r} and {second.name or ''!r} have modes of different kinds")
    else:
        message = f"the {type(element).__name__} does not compare modes"
        yield message if isinstance(element.container, am.ConditionConjunction) else Downgraded(message)


def _is_of_same_kind(first: am.ModeLabel, second: am.ModeLabel) -> bool:
    """Whether both have an enum mode or both a numeric one; am2inc reads a first label without a mode as numeric."""
    return isinstance(second.mode, am.EnumMode if isinstance(first.mode, am.EnumMode) else am.NumericMode)


@model_rule("INC-SW-GROUPNAME", am.Group)
def _check_group_name(element: am.Group, context: Context) -> Iterator[str]:
    first = element.items[0] if element.name and element.items and element.interruptible is not False else None
    if isinstance(first, am.Group | am.Switch | am.ModeSwitch | am.ProbabilitySwitch | am.WhileLoop):
        yield f"the name of the group {element.name!r} is dropped by am2inc, because it begins with a {type(first).__name__}"


#: The orders in which a group of a callback server can dispatch its services.
_POLICIES = ("FIFO", "LIFO", "Priority")


@model_rule("INC-SW-DISPATCH", am.CustomProperty)
def _check_dispatch(element: am.CustomProperty, context: Context) -> Iterator[str]:
    if metamodel(element) < "3":
        return
    holder, value = element.container, element.value
    if isinstance(holder, am.Task) and element.key == "callbackServer" and not isinstance(value, am.BooleanObject):
        yield f"the custom property 'callbackServer' of the task {holder.name or ''!r} is not a BooleanObject"
    if isinstance(holder, am.Group) and element.key == "dispatchingPolicy" and _is_server(holder.enclosing(am.Task)):
        policy = value.value if isinstance(value, am.StringObject) else None
        if policy not in _POLICIES:
            yield f"the custom property 'dispatchingPolicy' of the group {holder.name or ''!r} is not one of {', '.join(_POLICIES)}"


def _is_server(task: am.Task | None) -> bool:
    """Whether a task is a callback server, whose groups are services."""
    properties = task.custom_properties if task is not None else []
    return any(p.key == "callbackServer" and isinstance(p.value, am.BooleanObject) and p.value.value for p in properties)


@model_rule("INC-SW-EVENTMASK", am.EventMask)
def _check_eventmask(element: am.EventMask, context: Context) -> Iterator[str]:
    match len(element.events):
        case 0:
            yield "the event mask is empty, so the access has no effect"
        case count if count > 1:
            yield f"only the first of the {count} events in the mask is used by am2inc"
