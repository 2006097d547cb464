"""Types of values on the command line: files, texts that a function converts, words between commas."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import isfinite
from pathlib import Path
from typing import Any, TypeVar

import click
from click.shell_completion import CompletionItem

from amalthea_uros._internal.files import STANDARD_INPUT, STANDARD_OUTPUT, is_stream
from amalthea_uros._internal.similar import did_you_mean

T = TypeVar("T")


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


class SuffixedFile(FileType):
    """A file to write, whose suffix has to be one of its format; `-` is standard output."""

    def __init__(self, reason: str, *suffixes: str) -> None:
        super().__init__(STANDARD_OUTPUT, dir_okay=False)
        self.suffixes = suffixes
        self.reason = reason

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Parse one value."""
        try:
            return self.checked(super().convert(value, param, ctx))
        except ValueError as error:
            self.fail(str(error), param, ctx)

    def checked(self, path: Path) -> Path:
        """The path; ValueError for another suffix."""
        if path != STANDARD_OUTPUT and path.suffix.lower() not in self.suffixes and not is_stream(path):
            raise ValueError(f"'{path}' does not end with {' or '.join(self.suffixes)}; {self.reason}")
        return path


PICTURE = SuffixedFile("pictures are written as SVG", ".svg")
MODEL = SuffixedFile("models are written as AMALTHEA XML", ".amxmi")
DESCRIPTION = SuffixedFile("descriptions are written as YAML", ".yaml", ".yml")
MODEL_OR_DESCRIPTION = SuffixedFile("it is written as an AMALTHEA model or an app.yaml", ".amxmi", ".yaml", ".yml")


def output_path(text: str) -> Path:
    """A file to write that is given as part of an option."""
    return STANDARD_OUTPUT if text == "-" else Path(text)


class PositiveNumber(click.FloatRange):
    """A number above zero, and below a limit if there is one; click itself takes `nan` and `inf` for numbers."""

    def __init__(self, below: float | None = None) -> None:
        super().__init__(min=0, min_open=True, max=below, max_open=below is not None)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Parse one value."""
        number = super().convert(value, param, ctx)
        if not isfinite(number):
            self.fail(f"{value!r} is not a finite number", param, ctx)
        return number


POSITIVE = PositiveNumber()


def picture_path(text: str) -> Path:
    """A picture that is given as part of an option; ValueError for another suffix."""
    return PICTURE.checked(output_path(text))


class Parsed(click.ParamType[T]):
    """Text that a function converts, which raises a `ValueError` for wrong text."""

    def __init__(self, form: str, parse: Callable[[str], T]) -> None:
        self.name = form
        self._parse = parse

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> T:
        """Parse one value."""
        try:
            return self._parse(str(value))
        except ValueError as error:
            self.fail(str(error), param, ctx)


def assignment(form: str, convert: Callable[[str], T]) -> Parsed[tuple[str, T]]:
    """Text of the form NAME=VALUE; a function that raises a `ValueError` for wrong text converts the value."""

    def parse(text: str) -> tuple[str, T]:
        name, _, value = text.partition("=")
        if not name or not value:
            raise ValueError(f"{text!r} is not of the form {form}")
        return name, convert(value)

    return Parsed(form, parse)


class Several(click.ParamType[str]):
    """One word, or several with commas between them."""

    def __init__(self, name: str, allowed: Sequence[str] = ()) -> None:
        self.name = name
        self.allowed = allowed

    def convert(self, value: str, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Check the words."""
        for word in value.split(","):
            if self.allowed and word not in self.allowed:
                self.fail(f"{word!r} is not one of {', '.join(self.allowed)}", param, ctx)
        return value

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        """The words that the last one can become."""
        before, comma, last = incomplete.rpartition(",")
        return [CompletionItem(f"{before}{comma}{word}") for word in self.allowed if word.startswith(last)]


def several(*names: str, of: Several, text: str) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """An option that may be repeated, whose values are the words of all of them."""

    def words(_context: click.Context, _parameter: click.Parameter, values: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(word for value in values for word in value.split(","))

    return click.option(*names, type=of, multiple=True, callback=words, help=text)


class Offer(click.Choice[str]):
    """One of the names that `amuros init --list` explains; a wrong one gets a suggestion."""

    name = "NAME"

    def __init__(self, names: Sequence[str], advice: str = "") -> None:
        super().__init__(names)
        self._advice = advice

    def get_metavar(self, param: click.Parameter, ctx: click.Context) -> str:
        """The names are in the help text."""
        return self.name

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Check the name."""
        if value not in self.choices:
            advice = did_you_mean(value, self.choices) or f"known names: {', '.join(self.choices)}{self._advice}"
            self.fail(f"there is no {value!r}; {advice}", param, ctx)
        return str(value)
