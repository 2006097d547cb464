"""The option `--output FORMAT[=FILE]`, which may be repeated."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import IO, Any, NamedTuple

import click


class Output(NamedTuple):
    """One wish of the user: a format, and the file for it (None: standard output)."""

    format: str
    path: Path | None

    def write(self, render: Callable[[IO[str]], None]) -> None:
        """Render to where the user wants it.

        Raises
        ------
        WriteError : the file cannot be written.
        """
        if self.path is None:
            render(sys.stdout)
            return
        from io import StringIO

        from amalthea_uros.xmi.files import FileText, write_text

        text = StringIO()
        render(text)
        write_text(self.path, FileText(text.getvalue()))


class OutputType(click.ParamType[Output]):
    """`json` or `json=result.json`."""

    name = "FORMAT[=FILE]"

    def __init__(self, formats: Iterable[str]) -> None:
        self.formats = tuple(formats)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Output:
        """Parse one value."""
        if isinstance(value, Output):
            return value
        name, _, path = str(value).partition("=")
        if name not in self.formats:
            self.fail(f"{name!r} is not a format, expected one of {', '.join(self.formats)}", param, ctx)
        return Output(name, Path(path) if path else None)


def output_option(*formats: str) -> Callable[[Any], Any]:
    """The option for a command that knows these formats; the first one is the default."""
    return click.option(
        "--output",
        "outputs",
        type=OutputType(formats),
        multiple=True,
        default=(formats[0],),
        show_default=True,
        help=f"What to write, and where to: {', '.join(formats)}. May be repeated.",
    )
