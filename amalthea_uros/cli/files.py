"""Files on the command line; `-` is standard input or standard output."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import click

from amalthea_uros._internal.files import STANDARD_INPUT, STANDARD_OUTPUT, is_standard_output


class FileType(click.Path):
    """A path; `-` stands for another one."""

    def __init__(self, standard: Path, dir_okay: bool = True) -> None:
        super().__init__(path_type=Path, dir_okay=dir_okay)
        self.standard = standard

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Parse one value."""
        return self.standard if str(value) == "-" else super().convert(value, param, ctx)


INPUT = FileType(STANDARD_INPUT)
OUTPUT = FileType(STANDARD_OUTPUT)
#: Like `OUTPUT`, for what can only be a file.
OUTPUT_FILE = FileType(STANDARD_OUTPUT, dir_okay=False)


def output_path(text: str) -> Path:
    """A file to write that is given as part of an option."""
    return STANDARD_OUTPUT if text == "-" else Path(text)


def refuse_mixture(uses: Iterable[tuple[str, Path | None]]) -> None:
    """Refuse that several options write to standard output.

    Parameters
    ----------
    uses : options as the user gave them, with their files; None: not given

    Raises
    ------
    UsageError : they would be mixed.
    """
    options = [option for option, path in uses if path is not None and is_standard_output(path)]
    if len(options) > 1:
        raise click.UsageError(f"{' and '.join(options)} both write to standard output; give all but one of them a file.")
