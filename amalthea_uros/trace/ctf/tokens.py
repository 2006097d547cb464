"""The words of the language in which the metadata of CTF traces are written (TSDL)."""

from __future__ import annotations

import re
from typing import NamedTuple

_TOKEN = re.compile(
    r"""(?P<skip>\s+|//[^\n]*|/\*.*?\*/)
    |(?P<text>"(?:[^"\\\n]|\\.)*")
    |(?P<char>'(?:[^'\\\n]|\\.)')
    |(?P<number>(?:0[xX][0-9a-fA-F]+|[0-9]+)[uUlL]*)
    |(?P<word>[A-Za-z_][A-Za-z0-9_]*)
    |(?P<sign>:=|\.\.\.|->|[{}\[\]()<>;:,.=*+-])""",
    re.VERBOSE | re.DOTALL,
)


class MetadataError(Exception):
    """The metadata cannot be understood.

    Attributes
    ----------
    line : counted from 1
    """

    def __init__(self, message: str, line: int) -> None:
        super().__init__(message)
        self.line = line


class Token(NamedTuple):
    """A word, number, text or sign; `kind` is the name of a group above, or "end"."""

    kind: str
    text: str
    line: int


def tokens(source: str, most: int) -> list[Token]:
    """The tokens of a text, with one for the end.

    Raises
    ------
    MetadataError : there is something that is none, or there are too many.
    """
    found: list[Token] = []
    place, line = 0, 1
    while place < len(source):
        match = _TOKEN.match(source, place)
        if match is None or len(found) >= most:
            raise MetadataError("a character that TSDL does not know" if match is None else f"more than {most:,} words", line)
        kind = match.lastgroup or "skip"
        if kind != "skip":
            found.append(Token(kind, match[0], line))
        line += match[0].count("\n")
        place = match.end()
    return [*found, Token("end", "", line)]
