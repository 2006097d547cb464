"""Options whose text a function converts."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

T = TypeVar("T")


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
