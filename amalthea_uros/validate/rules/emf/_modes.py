"""Values of modes."""

from __future__ import annotations

import re

from amalthea_uros.metamodel.classes import EnumMode, Mode, NumericMode

_INTEGER = re.compile(r"-?[0-9]+")


def is_value_of(mode: Mode | None, value: str) -> bool:
    """Whether a text is a value of a mode; True if the mode is not known."""
    if isinstance(mode, EnumMode) and mode.unresolved is None:
        return value.strip() in {literal.name for literal in mode.literals}
    if isinstance(mode, NumericMode) and mode.unresolved is None:
        return _INTEGER.fullmatch(value.strip()) is not None
    return True


def allowed_values(mode: Mode | None) -> str:
    """The values of a mode, in words."""
    if isinstance(mode, EnumMode):
        return f"one of {', '.join(repr(literal.name) for literal in mode.literals)}"
    return "an integer"
