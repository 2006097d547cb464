"""`amuros diff`: two models compared by meaning."""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path

import click

from amalthea_uros.cli.output import Output, output_option
from amalthea_uros.metamodel.difference import difference
from amalthea_uros.report.difference import write_json, write_text
from amalthea_uros.xmi.load import load


@click.command("diff")
@click.argument("old", type=click.Path(path_type=Path))
@click.argument("new", type=click.Path(path_type=Path))
@output_option("text", "json")
def command(old: Path, new: Path, outputs: tuple[Output, ...]) -> None:
    """Compare two models by meaning.

    OLD and NEW are files or folders with .amxmi files. Objects are matched by name, wherever they stand; layout, spelling and
    written-out defaults mean nothing. Exit code 0 if there is no difference, 1 if there is one.
    """
    changes = difference(load(old), load(new))
    for output in outputs:
        output.write(partial(write_json, changes, old, new) if output.format == "json" else partial(write_text, changes))
    sys.exit(1 if changes else 0)
