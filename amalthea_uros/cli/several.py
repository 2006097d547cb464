"""Options with several values, also with commas between them."""

from __future__ import annotations

from collections.abc import Sequence

import click
from click.shell_completion import CompletionItem


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


def several(_context: click.Context, _parameter: click.Parameter, values: tuple[str, ...]) -> tuple[str, ...]:
    """The words of all values of an option; the callback of an option of this type."""
    return tuple(word for value in values for word in value.split(","))
