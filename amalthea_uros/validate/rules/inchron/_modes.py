"""Values of mode labels as am2inc reads them."""

from __future__ import annotations

import re

from amalthea_uros.metamodel.classes import EnumMode, Mode

_INTEGER = re.compile(r"\s*[+-]?[0-9]+").fullmatch


def fault(value: str | None, mode: Mode | None) -> str | None:
    """What is wrong with a value of a mode, None if nothing. A label without a mode is read as one of a numeric mode."""
    if mode is not None and mode.unresolved is not None:
        return None
    if isinstance(mode, EnumMode):
        known = any(literal.name == value for literal in mode.literals)
        return None if known else f"{value or ''!r}, which is no literal of {mode.name!r}"
    is_integer = value is not None and _INTEGER(value) and -(2**31) <= int(value) < 2**31
    return None if is_integer else f"{value or ''!r}, which is no integer of 32 bits"
