"""Output formats. A new one is a new file here: a module that has the attributes of `Format`.

Commands import all of them to list their names, so what only the writing needs is imported there.
"""

from __future__ import annotations

from collections.abc import Container
from importlib import import_module
from pkgutil import iter_modules
from typing import IO, Any, Protocol, cast

#: The format that people read; the default of every command.
TEXT = "text"


class Format(Protocol):
    """A way to write results.

    Attributes
    ----------
    RENDERS : the names of the result classes that it can write, so that none of them has to be imported to know that
    """

    @property
    def RENDERS(self) -> Container[str]:  # noqa: N802 - a constant of a module
        """The names of the result classes."""

    def write(self, result: Any, stream: IO[str], /) -> None:
        """Write a result."""


def formats_for(result: type) -> list[str]:
    """The names of the formats that can write a result, text first."""
    names = sorted(module.name for module in iter_modules(__path__))
    return sorted((name for name in names if result.__name__ in _format(name).RENDERS), key=lambda name: name != TEXT)


def write(name: str, result: object, stream: IO[str]) -> None:
    """Write a result in a format."""
    _format(name).write(result, stream)


def _format(name: str) -> Format:
    return cast("Format", import_module(f"{__name__}.{name}"))
