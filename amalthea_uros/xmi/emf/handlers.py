"""The handlers of a parser of expat: set in one way for files of all versions."""

from __future__ import annotations

import re
from collections.abc import Callable
from itertools import islice
from typing import Any
from xml.parsers import expat

#: Something else than white space between two tags, or a `>` in a value or a comment.
_BETWEEN_TAGS = re.compile(rb">[ \t\r\n]*+[^<]")

#: So many `>` are looked at, in tags of at most so many characters: more would take longer than calls of the handler for nothing.
_MOST_LOOKED_AT, _LONGEST_TAG = 2_000, 2_000

_CDATA = b"<![CDATA["


def connect(
    parser: Any,
    utf8: bytes,
    *,
    start: Callable[[str, dict[str, str]], None],
    end: Callable[[str], None],
    characters: Callable[[str], None],
    comment: Callable[[str], None],
    processing_instruction: Callable[[str, str], None],
    doctype: Callable[..., None],
) -> None:
    """Let a parser report the parts of a text, which is in UTF-8; it may be given other handlers for elements meanwhile."""
    parser.SetParamEntityParsing(expat.XML_PARAM_ENTITY_PARSING_NEVER)
    parser.buffer_text = True
    parser.StartDoctypeDeclHandler = doctype
    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.CommentHandler = comment
    parser.ProcessingInstructionHandler = processing_instruction
    if has_character_data(utf8):
        # Larger than any text, so that one that is longer than the usual buffer is not reported in pieces.
        parser.buffer_size = len(utf8)
        parser.CharacterDataHandler = characters


def disconnect(parser: Any) -> None:
    """Break the cycle of parser and reader, which would keep the text alive until the next collection."""
    for handler in ("StartElement", "EndElement", "CharacterData", "Comment", "ProcessingInstruction", "StartDoctypeDecl"):
        setattr(parser, f"{handler}Handler", None)


def has_character_data(utf8: bytes) -> bool:
    """Whether there may be text between the tags; models have white space only, and to be called for that takes long."""
    found = _BETWEEN_TAGS.finditer(utf8)
    if not all(_is_in_value(utf8, match.start()) for match in islice(found, _MOST_LOOKED_AT)):
        return True
    # One byte is found ten times faster than several.
    return next(found, None) is not None or (b"!" in utf8 and _CDATA in utf8)


def _is_in_value(utf8: bytes, place: int) -> bool:
    """Whether a `>` is certainly part of a value of an attribute, or of a comment that goes on after it."""
    start = utf8.rfind(b"<", max(0, place - _LONGEST_TAG), place)
    return (
        start >= 0
        and utf8.count(b'"', start, place) % 2 == 1
        and utf8.find(b"'", start, place) < 0
        # The end of a comment or an instruction that has quotes in it.
        and utf8[place - 1 : place] not in (b"-", b"?")
    )
