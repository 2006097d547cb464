"""How am2inc reads values of mode labels."""

from __future__ import annotations

import re

from amalthea_uros.metamodel.classes import EnumMode, Mode

_INTEGER = re.compile(r"\s*[+-]?[0-9]+").fullmatch


def fault(value: str | None, mode: Mode | None) -> str | None:
    """Why a value is invalid for a mode, None if it is valid. A label without a mode is read as one with a numeric mode."""
    if mode is not None and mode.unresolved is not None:
        return None
    if isinstance(mode, EnumMode):
        known = any(literal.name == value for literal in mode.literals)
        return None if known else f"{value or ''!r}, which is not a literal of {mode.name or ''!r}"
    is_integer = value is not None and _INTEGER(value) and -(2**31) <= int(value) < 2**31
    return None if is_integer else f"{value or ''!r}, which is not a 32-bit integer"
