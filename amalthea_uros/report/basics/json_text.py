"""JSON that people can read, too: indented, but what consists of numbers alone takes one line."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache
from json import JSONEncoder
from typing import IO, Any

from amalthea_uros.report.basics.escape import visible_json

_INDENT = "  "
_NUMBERS = frozenset({int, float, bool, type(None)})


def write_json(content: Any, stream: IO[str]) -> None:
    """Write a value as JSON that can be shown, too: hidden characters, and those that the stream lacks, are escapes of JSON."""
    text = visible_json(_JsonText(JSONEncoder(ensure_ascii=False).encode).of(content, "\n")) + "\n"
    try:
        text.encode(getattr(stream, "encoding", None) or "utf-8")
    except UnicodeEncodeError:
        text = _JsonText(JSONEncoder().encode).of(content, "\n") + "\n"
    stream.write(text)


class _JsonText:
    """Encodes values, and the name of a field once.

    A histogram has hundreds of numbers. With a line for each, most of a long result would be margins; with several on a line, the
    library encodes them at once.
    """

    def __init__(self, encode: Callable[[Any], str]) -> None:
        self._encode = encode
        self._name = cache(lambda name: f"{encode(str(name))}: ")

    def of(self, value: Any, line: str) -> str:
        """The text of a value, of which every further line begins with a line end and a margin."""
        if type(value) is int:
            return str(value)
        if not isinstance(value, dict | list | tuple) or _NUMBERS.issuperset(map(type, _members(value))):
            return self._encode(value)
        inner = line + _INDENT
        if isinstance(value, dict):
            fields = [inner + self._name(name) + self.of(each, inner) for name, each in value.items()]
            return "".join(("{", ",".join(fields), line, "}"))
        return "".join(("[", ",".join([inner + self.of(each, inner) for each in value]), line, "]"))


def _members(value: dict[str, Any] | list[Any] | tuple[Any, ...]) -> Iterable[Any]:
    return value.values() if isinstance(value, dict) else value
