"""Mode labels, and the values that are accessed and compared."""

from __future__ import annotations

import re
from collections.abc import Iterator

from amalthea_uros.metamodel import classes as am
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import model_rule

_INTEGER = re.compile(r"-?[0-9]+")


def is_value_of(mode: am.Mode | None, value: str) -> bool:
    """Whether a text is a value of a mode; True if the mode is not known."""
    if isinstance(mode, am.EnumMode) and mode.unresolved is None:
        return value.strip() in {literal.name for literal in mode.literals}
    if isinstance(mode, am.NumericMode) and mode.unresolved is None:
        return _INTEGER.fullmatch(value.strip()) is not None
    return True


def allowed_values(mode: am.Mode | None) -> str:
    """The values of a mode, in words."""
    if isinstance(mode, am.EnumMode):
        return f"one of {', '.join(repr(literal.name) for literal in mode.literals)}"
    return "an integer"


@model_rule("AM-EMF-INTRINSIC/ModeLabel", am.ModeLabel)
def _check_label(element: am.ModeLabel, context: Context) -> Iterator[str]:
    if element.mode is None:
        yield f"mode label {element.name!r} has no mode"
    elif element.initial_value is not None and not is_value_of(element.mode, element.initial_value):
        yield f"the initial value {element.initial_value!r} of {element.name!r} is not {allowed_values(element.mode)}"


@model_rule("AM-EMF-INTRINSIC/ModeLabelAccess", am.ModeLabelAccess)
def _check_access(element: am.ModeLabelAccess, context: Context) -> Iterator[str]:
    label = element.data
    if label is None:
        yield "the access has no mode label"
    elif label.mode is None and label.unresolved is None:
        yield f"mode label {label.name!r} has no mode"
    elif (
        element.access == am.ModeLabelAccessEnum.SET
        and element.value is not None
        and not is_value_of(label.mode, element.value)
    ):
        yield f"the value {element.value!r} set in {label.name!r} is not {allowed_values(label.mode)}"


@model_rule("AM-EMF-INTRINSIC/ModeValue", am.ModeValue)
def _check_value(element: am.ModeValue, context: Context) -> Iterator[str]:
    label = element.label
    if label is None:
        yield "the mode value has no mode label"
    elif label.mode is None and label.unresolved is None:
        yield f"mode label {label.name!r} has no mode"
    elif element.value is None:
        yield f"mode label {label.name!r} is used without a value"
    elif not is_value_of(label.mode, element.value):
        yield f"the value {element.value!r} for {label.name!r} is not {allowed_values(label.mode)}"
