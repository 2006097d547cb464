"""`amuros init`: the first app.yaml."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from amalthea_uros._internal.files import STANDARD_OUTPUT
from amalthea_uros._internal.resources import known_platforms
from amalthea_uros._internal.similar import did_you_mean
from amalthea_uros.cli.files import OUTPUT
from amalthea_uros.cli.output import show_text
from amalthea_uros.services.init import DEFAULT_BOARD, catalogue, example_names, init_from_board, init_from_example


class Offer(click.Choice[str]):
    """One of the names that `--list` explains; a wrong one gets a suggestion."""

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


_ANOTHER_BOARD = "; for another controller omit --board, and set its frequency and cores in the file"
_BOARDS, _EXAMPLES = known_platforms(), example_names()


@click.command("init")
@click.argument("target", type=OUTPUT, default=Path(), metavar="[FILE_OR_FOLDER]")
@click.option(
    "--board", type=Offer(_BOARDS, _ANOTHER_BOARD), help=f"Controller: {', '.join(_BOARDS)}. Default: {DEFAULT_BOARD}."
)
@click.option("--example", type=Offer(_EXAMPLES), help=f"Copy an example: {', '.join(_EXAMPLES)}.")
@click.option("--list", "lists", is_flag=True, help="List the boards and the examples, and write nothing.")
@click.option("--force", is_flag=True, help="Replace a file that exists.")
def command(target: Path, board: str | None, example: str | None, lists: bool, force: bool) -> None:
    """Write a commented app.yaml that can be built, checked and analyzed at once.

    Without FILE_OR_FOLDER it becomes app.yaml in the current folder; with '-', it is written to standard output.
    """
    if lists:
        show_text(catalogue())
        return
    if board is not None and example is not None:
        raise click.UsageError("--board and --example exclude each other; an example states its own board")
    if example is not None:
        result = init_from_example(target, example, force=force)
    else:
        result = init_from_board(target, board or DEFAULT_BOARD, force=force)
    if result.path != STANDARD_OUTPUT:
        show_text(result)
