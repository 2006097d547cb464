"""Completion of keys: the values of the file on the command line that `--set`, `--sweep` and `--offer` can change."""

from __future__ import annotations

from typing import TypeVar

import click
from click.shell_completion import CompletionItem

from amalthea_uros.cli.parameters import Parsed

T = TypeVar("T")
#: A shell shows no more than that in a useful way.
_MOST = 500


class OfKey(Parsed[T]):
    """Text that begins with a key of the file on the command line."""

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        """The keys that the text can become; those with attributes of a model once there is a text."""
        from amalthea_uros.errors import AmurosError, InvalidArgumentError
        from amalthea_uros.services.keys import keys

        # While the last option has no value, click keeps the files as arguments that are left over.
        paths = ctx.params.get("paths") or ctx.params.get("model") or ctx.args
        if not paths or "=" in incomplete:
            return []
        try:
            values = keys([paths] if not isinstance(paths, list | tuple) else list(paths), matching=incomplete)
        except (AmurosError, InvalidArgumentError, OSError):
            return []
        begun = [each for each in values if each.name.casefold().startswith(incomplete.casefold())]
        return [CompletionItem(f"{each.name}=", help=each.value) for each in begun[:_MOST]]
