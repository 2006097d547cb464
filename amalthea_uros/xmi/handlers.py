"""The handlers of a parser of expat: set in one way for files of all versions."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any
from xml.parsers import expat

#: Something else than white space between two tags. It also finds `>` in values and comments; then the handler is called for nothing.
_BETWEEN_TAGS = re.compile(r">[ \t\r\n]*+[^<]")

_CDATA = "<![CDATA["


@dataclass(frozen=True, eq=False)
class Handlers:
    """What a reader does at each part of a file; the parser may be given others for elements meanwhile."""

    start: Callable[[str, dict[str, str]], None]
    end: Callable[[str], None]
    characters: Callable[[str], None]
    comment: Callable[[str], None]
    processing_instruction: Callable[[str, str], None]
    doctype: Callable[..., None]


def connect(parser: Any, text: str, handlers: Handlers) -> None:
    """Let a parser report the parts of a text."""
    parser.SetParamEntityParsing(expat.XML_PARAM_ENTITY_PARSING_NEVER)
    parser.buffer_text = True
    parser.StartDoctypeDeclHandler = handlers.doctype
    parser.StartElementHandler = handlers.start
    parser.EndElementHandler = handlers.end
    parser.CommentHandler = handlers.comment
    parser.ProcessingInstructionHandler = handlers.processing_instruction
    if has_character_data(text):
        # Larger than any text, so that one that is longer than the usual buffer is not reported in pieces.
        parser.buffer_size = len(text.encode())
        parser.CharacterDataHandler = handlers.characters


def disconnect(parser: Any) -> None:
    """Break the cycle of parser and reader, which would keep the text alive until the next collection."""
    for handler in ("StartElement", "EndElement", "CharacterData", "Comment", "ProcessingInstruction", "StartDoctypeDecl"):
        setattr(parser, f"{handler}Handler", None)


def has_character_data(text: str) -> bool:
    """Whether there may be text between the tags; models have white space only, and to be called for that takes long."""
    return _BETWEEN_TAGS.search(text) is not None or _CDATA in text
