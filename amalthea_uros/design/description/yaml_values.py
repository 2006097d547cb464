"""Values as YAML in flow style, which is valid wherever a value can be."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import TypeAlias

#: What can be written: text as it is read again, numbers, lists and mappings.
Value: TypeAlias = "str | int | Sequence[Value] | Mapping[str, Value]"

#: Text that means itself without quotes, in blocks and in flow style.
_PLAIN = re.compile(r"(?:[A-Za-z_/.]|\d+(?:\.\d+)? ?[A-Za-z])[\w./ -]*(?<! )", re.ASCII)
_WORDS = ("null", "true", "false", "~")


def rendered(value: Value, quote: str = "") -> str:
    """The YAML text of a value.

    Parameters
    ----------
    quote : that the text had before; it is kept
    """
    if isinstance(value, int):
        return str(value)
    if isinstance(value, str):
        return _text(value, quote)
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_text(key, '')}: {rendered(item)}" for key, item in value.items()) + "}"
    return "[" + ", ".join(rendered(item) for item in value) + "]"


def _text(text: str, quote: str) -> str:
    if quote == '"' and text.isprintable() and not {'"', "\\"} & set(text):
        return f'"{text}"'
    if quote == "'" or not _PLAIN.fullmatch(text) or text.lower() in _WORDS:
        return "'" + text.replace("'", "''") + "'"
    return text
