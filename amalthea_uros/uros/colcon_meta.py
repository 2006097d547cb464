"""Reading `colcon.meta`, the file that sets build options of packages (https://colcon.readthedocs.io/en/released/user/configuration.html).

People write JSON with comments and trailing commas; colcon reads the file as YAML (colcon/colcon-metadata
colcon_metadata/package_discovery/colcon_meta.py), in which `#` starts a comment, but `//` and `/*` do not: they become a part of the
next value, so that its option is lost, or colcon skips the whole file.
"""

from __future__ import annotations

import json
import re
from bisect import bisect_right
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.perf.named import Brief

_TOKEN = re.compile(
    r"""(?P<space>[\s\ufeff]+|\#[^\n]*)
    |(?P<comment>//[^\n]*|/\*(?:[^*]|\*(?!/))*\*/)
    |(?P<text>"(?:[^"\\\n]|\\.)*")
    |(?P<mark>[{}\[\],:])
    |(?P<word>[A-Za-z0-9.+_-]+)""",
    re.VERBOSE,
)
#: `-DNAME=VALUE` or `-DNAME:TYPE=VALUE`.
_DEFINITION = re.compile(r"-D\s*(?P<name>[A-Za-z0-9_]+)(?::[A-Za-z]+)?=(?P<value>.*)", re.DOTALL)
#: Levels of lists and mappings; a `colcon.meta` has four.
_MAX_DEPTH = 50


@dataclass(frozen=True, slots=True, kw_only=True)
class Definition(Brief):
    """A build option that a file sets."""

    package: str
    name: str
    value: str
    location: Location


@dataclass(frozen=True, slots=True, kw_only=True)
class ColconMeta(Brief):
    """The build options of a file.

    Attributes
    ----------
    comments : places of comments that colcon takes for values
    """

    path: Path
    definitions: tuple[Definition, ...]
    comments: tuple[Location, ...]


class _Token(NamedTuple):
    kind: str
    text: str
    start: int


class _Text(NamedTuple):
    """A text of the file, and where it starts."""

    value: str
    start: int


def parse_meta(path: Path, text: str) -> ColconMeta:
    """The build options in the text of a file.

    Raises
    ------
    ReadError : it is not such a file.
    """
    reader = _JsonReader(path, text)
    content = reader.content()
    return ColconMeta(
        path=path, definitions=tuple(_definitions(content, reader)), comments=tuple(map(reader.location, reader.comments))
    )


def _definitions(content: Any, reader: _JsonReader) -> Iterator[Definition]:
    names = _entry(content, "names")
    if not isinstance(names, list):
        raise reader.mistake("it has no mapping 'names' of packages", 0)
    for package, settings in names:
        arguments = _entry(settings, "cmake-args")
        for argument in arguments if isinstance(arguments, tuple) else ():
            found = _DEFINITION.fullmatch(argument.value) if isinstance(argument, _Text) else None
            if found is not None:
                yield Definition(
                    package=package.value, name=found["name"], value=found["value"], location=reader.location(argument.start)
                )


def _entry(mapping: Any, key: str) -> Any:
    """The value of a key; the last one counts, as for colcon."""
    found = [value for name, value in mapping if name.value == key] if isinstance(mapping, list) else []
    return found[-1] if found else None


class _JsonReader:
    """Reads JSON with comments and trailing commas: a mapping as a list of pairs, a list as a tuple."""

    def __init__(self, path: Path, text: str) -> None:
        self.path, self.text = path, text
        self.comments: list[int] = []
        self._lines = [0, *(found.end() for found in re.finditer("\n", text))]
        self._tokens = self._scan()
        self._next = next(self._tokens)

    def content(self) -> Any:
        """The only value of the file."""
        value = self._value(0)
        if self._next.kind != "end":
            raise self._unexpected("the end of the file")
        return value

    def location(self, start: int) -> Location:
        """The place of a character."""
        line = bisect_right(self._lines, start)
        begin = self._lines[line - 1]
        end = self.text.find("\n", begin)
        return Location(self.path, line, start - begin + 1, self.text[begin : end if end >= 0 else None])

    def mistake(self, what: str, start: int) -> ReadError:
        """The exception for a file that is wrong somewhere."""
        advice = (
            "Expected {'names': {PACKAGE: {'cmake-args': ['-DOPTION=VALUE', ...]}}}, as in the examples of colcon.".replace(
                "'", '"'
            )
        )
        return ReadError([Finding("GEN006", Severity.ERROR, f"not a colcon.meta: {what}", self.location(start), advice)])

    def _scan(self) -> Iterator[_Token]:
        position = 0
        while position < len(self.text):
            found = _TOKEN.match(self.text, position)
            if found is None or found.lastgroup is None:
                raise self.mistake(f"unexpected character {self.text[position]!r}", position)
            if found.lastgroup == "comment":
                self.comments.append(position)
            elif found.lastgroup != "space":
                yield _Token(found.lastgroup, found[0], position)
            position = found.end()
        while True:
            yield _Token("end", "", max(len(self.text) - 1, 0))

    def _advance(self) -> _Token:
        token, self._next = self._next, next(self._tokens)
        return token

    def _value(self, depth: int) -> Any:
        if depth > _MAX_DEPTH:
            raise self.mistake(f"more than {_MAX_DEPTH} levels of lists and mappings", self._next.start)
        match self._next:
            case ("text", _, _):
                return self._text()
            case ("word", word, _):
                self._advance()
                return word
            case (_, "{", _):
                return [*self._items("}", lambda: self._pair(depth + 1))]
            case (_, "[", _):
                return (*self._items("]", lambda: self._value(depth + 1)),)
        raise self._unexpected("a value")

    def _items(self, end: str, item: Any) -> Iterator[Any]:
        self._advance()
        while self._next.text != end:
            yield item()
            if self._next.text == ",":
                self._advance()
            elif self._next.text != end:
                raise self._unexpected(f"',' or {end!r}")
        self._advance()

    def _pair(self, depth: int) -> tuple[_Text, Any]:
        if self._next.kind != "text":
            raise self._unexpected("a name in quotes")
        name = self._text()
        if self._next.text != ":":
            raise self._unexpected("':'")
        self._advance()
        return name, self._value(depth)

    def _text(self) -> _Text:
        token = self._advance()
        try:
            return _Text(json.loads(token.text, strict=False), token.start)
        except ValueError:
            raise self.mistake("invalid text in quotes", token.start) from None

    def _unexpected(self, expected: str) -> ReadError:
        found = repr(self._next.text[:40]) if self._next.kind != "end" else "the end of the file"
        return self.mistake(f"expected {expected}, found {found}", self._next.start)
