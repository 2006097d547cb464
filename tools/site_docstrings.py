"""Reads the docstrings of amuros: `name : what it is` on one line, as types are in the signatures, where NumPy has two lines."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import griffe

_SECTION = re.compile(r"(Parameters|Attributes|Raises|Returns|Yields)")
_ENTRY = re.compile(r"(\S[^:]*?) : (.+)")


class OneLineEntries(griffe.Extension):
    """Gives the parser of NumPy docstrings what it expects."""

    def on_object(self, *, obj: griffe.Object, **kwargs: Any) -> None:
        """Rewrite the docstring of an object after it was read."""
        if obj.docstring is not None:
            obj.docstring.value = "\n".join(_expanded(obj.docstring.value.splitlines()))


def _expanded(lines: list[str]) -> Iterator[str]:
    is_list = False
    for line, following in zip(lines, [*lines[1:], ""], strict=True):
        if following.startswith("---"):
            is_list = _SECTION.fullmatch(line) is not None
        entry = _ENTRY.fullmatch(line) if is_list else None
        yield from (line,) if entry is None else (entry[1], f"    {entry[2]}")
