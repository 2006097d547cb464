"""Attribute values as they are written between quotes."""

from __future__ import annotations

import re

#: What EMF escapes; `>` and `'` stay as they are.
_SPECIAL = re.compile(r'[&<"\t\n\r]')
_ESCAPES = {"&": "&amp;", "<": "&lt;", '"': "&quot;", "\t": "&#x9;", "\n": "&#xA;", "\r": "&#xD;"}

#: What XML 1.0 counts as white space (section 2.3); Python counts more.
WHITE_SPACE = " \t\r\n"

#: Characters that XML 1.0 does not allow, not even escaped.
_IMPOSSIBLE = "[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]"

_REFERENCE = re.compile(r"&(?:#x([0-9a-fA-F]+)|#([0-9]+)|(amp|lt|gt|quot|apos));|(\r\n|[\t\n\r])")
_ENTITIES = {"amp": "&", "lt": "<", "gt": ">", "quot": '"', "apos": "'"}


def escape(value: str) -> str:
    """A value for use between double quotes."""
    if not _SPECIAL.search(value):
        return value
    return _SPECIAL.sub(lambda match: _ESCAPES[match[0]], value)


def escape_text(value: str) -> str:
    """A text for use between tags, where a parser makes a line end of a carriage return, and `]]>` is forbidden (XML 1.0, 2.4)."""
    return value.replace("&", "&amp;").replace("<", "&lt;").replace("]]>", "]]&gt;").replace("\r", "&#xD;")


def impossible_character(value: str) -> str | None:
    """The first character that XML does not allow, None if there is none."""
    # None of them is printable.
    found = None if value.isprintable() else re.search(_IMPOSSIBLE, value)
    return found[0] if found else None


def unescape(raw: str) -> str:
    """The value that a parser reads from between the quotes (XML 1.0, 3.3.3: white space becomes a blank)."""
    return _REFERENCE.sub(_character, raw)


def _character(match: re.Match[str]) -> str:
    hexadecimal, decimal, entity, space = match.groups()
    if space:
        return " "
    return _ENTITIES[entity] if entity else chr(int(hexadecimal, 16) if hexadecimal else int(decimal))
