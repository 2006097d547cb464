"""The keys and words of an `app.yaml` at a position: completions, and what a key means."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

from lsprotocol import types

from amalthea_uros._internal.files import overlaid
from amalthea_uros._internal.resources import known_platforms
from amalthea_uros.editor.document import TextDocument
from amalthea_uros.editor.hover import MAX_LENGTH
from amalthea_uros.spec.cursor import place_of_key, place_of_value
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.schema_places import key_at, keys_at, words_at

#: A key, and what is before and after it.
_KEY = re.compile(r"(?<![^\s{,\[])([A-Za-z_]\w*)(?=\s*:(?:\s|$))")
#: What is before a value that somebody is writing, and the beginning of it.
_BEFORE_VALUE = re.compile(r"(.*(?<![^\s{,\[])[A-Za-z_]\w*:\s+|.*\[\s*|.*\[.*,\s*)([\w.-]*)")
#: Where the name of a platform is a value; the schema has only examples.
_PLATFORM = (("hardware",), ("hardware", "platform"))
_BEFORE_KEY = re.compile(r"(\s*(?:-\s+)*|.*[{,]\s*)(\w*)")


def completions(document: TextDocument, position: types.Position) -> list[types.CompletionItem]:
    """The keys that may be written at a position, or the words that may be the value there."""
    if not _is_examined(document):
        return []
    line = document.lines[position.line] if position.line < len(document.lines) else ""
    before = line[: document.column(position)]
    keys = list(_keys(document, position, before))
    return keys or list(_words(document, position, before))


def key_hover(document: TextDocument, position: types.Position) -> types.Hover | None:
    """The meaning of the key at a position; None if there is no key."""
    if not _is_examined(document) or position.line >= len(document.lines):
        return None
    line, column = document.lines[position.line], document.column(position)
    key = next((match for match in _KEY.finditer(line) if match.start() <= column <= match.end()), None)
    if key is None:
        return None
    cursor = place_of_key(_until(document, position.line, key.start()))
    schema = None if cursor is None else key_at(cursor.path, key[1], Description)
    if schema is None or "description" not in schema:
        return None
    where = types.Range(document.position(position.line, key.start()), document.position(position.line, key.end()))
    text = f"**{key[1]}**: {_meaning(schema)}"
    return types.Hover(contents=types.MarkupContent(types.MarkupKind.Markdown, text), range=where)


def _is_examined(document: TextDocument) -> bool:
    if not document.is_description or len(document.text) > MAX_LENGTH:
        return False
    with overlaid(document.contents):
        return document.is_ours


def _until(document: TextDocument, line: int, column: int) -> str:
    """The text before a place."""
    return "\n".join([*document.lines[:line], document.lines[line][:column]])


def _keys(document: TextDocument, position: types.Position, before: str) -> Iterator[types.CompletionItem]:
    match = _BEFORE_KEY.fullmatch(before)
    cursor = None if match is None else place_of_key(_until(document, position.line, len(match[1])))
    if cursor is None or match is None:
        return
    where = types.Range(document.position(position.line, len(match[1])), position)
    for key, schema in keys_at(cursor.path, Description).items():
        if key not in cursor.stated:
            yield types.CompletionItem(
                label=key,
                kind=types.CompletionItemKind.Property,
                documentation=types.MarkupContent(types.MarkupKind.Markdown, _meaning(schema)),
                text_edit=types.TextEdit(where, f"{key}: "),
            )


def _words(document: TextDocument, position: types.Position, before: str) -> Iterator[types.CompletionItem]:
    match = _BEFORE_VALUE.fullmatch(before)
    cursor = None if match is None else place_of_value(_until(document, position.line, len(match[1])))
    if cursor is None or match is None:
        return
    where = types.Range(document.position(position.line, len(match[1])), position)
    words = known_platforms() if cursor.path in _PLATFORM else words_at(cursor.path, Description)
    for word in words:
        yield types.CompletionItem(label=word, kind=types.CompletionItemKind.Value, text_edit=types.TextEdit(where, word))


def _meaning(schema: Mapping[str, Any]) -> str:
    """The description of a key, and its default."""
    default = schema.get("default")
    is_shown = isinstance(default, str | bool) and "pattern" not in schema
    stated = f" Default: `{str(default).lower() if isinstance(default, bool) else default}`." if is_shown else ""
    return f"{schema['description']}{stated}"
