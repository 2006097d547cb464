"""How am2inc reads values of mode labels."""

from __future__ import annotations

import re
from collections.abc import Iterator

from amalthea_uros.metamodel import classes as am
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, drops, model_rule

_INTEGER = re.compile(r"\s*[+-]?[0-9]+").fullmatch


def fault(value: str | None, mode: am.Mode | None) -> str | None:
    """Why a value is invalid for a mode, None if it is valid. A label without a mode is read as one with a numeric mode."""
    if mode is not None and mode.unresolved is not None:
        return None
    if isinstance(mode, am.EnumMode):
        known = any(literal.name == value for literal in mode.literals)
        return None if known else f"{value or ''!r}, which is not a literal of {mode.name or ''!r}"
    is_integer = value is not None and _INTEGER(value) and -(2**31) <= int(value) < 2**31
    return None if is_integer else f"{value or ''!r}, which is not a 32-bit integer"


@model_rule("INC-SW-MODE-MISSING", am.ModeLabel)
def _check_missing(element: am.ModeLabel, context: Context) -> Iterator[str]:
    if element.mode is None:
        yield f"the mode label {element.name or ''!r} has no mode"


@model_rule("INC-SW-MODE-NUMSET", am.ModeLabelAccess)
def _check_numeric_access(element: am.ModeLabelAccess, context: Context) -> Iterator[str]:
    match element:
        case am.ModeLabelAccess(data=am.ModeLabel(mode=am.NumericMode()) as label, access="set"):
            step = element.effective("step")
            yield f"the mode label {label.name or ''!r} is set to the step {step} instead of {element.value or ''!r}"


@model_rule("INC-SW-MODE-VALUE", am.ModeLabel, am.ModeValueCondition, am.ModeLabelAccess)
def _check_value(
    element: am.ModeLabel | am.ModeValueCondition | am.ModeLabelAccess, context: Context
) -> Iterator[str | Downgraded]:
    match element:
        case am.ModeLabel() if element.mode is not None and element.initial_value:
            yield from _faults(element, element.initial_value, "starts with")
        case am.ModeValueCondition() if element.label is not None and element.label.unresolved is None:
            yield from _faults(element.label, element.value, "is compared with")
        case am.ModeLabelAccess(data=am.ModeLabel(mode=am.EnumMode()) as label, access="set"):
            yield from map(drops, _faults(label, element.value, "is set to"))


def _faults(label: am.ModeLabel, value: str | None, use: str) -> Iterator[str]:
    found = fault(value, label.mode)
    if found is not None:
        yield f"the mode label {label.name or ''!r} {use} {found}"
