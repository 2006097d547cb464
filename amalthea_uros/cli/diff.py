"""`amuros diff`: two models compared by meaning."""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path

import click

from amalthea_uros.cli.output import Output, output_option
from amalthea_uros.difference.comparison import difference
from amalthea_uros.report.difference import write_json, write_text
from amalthea_uros.xmi.load import load


@click.command("diff")
@click.argument("old", type=click.Path(path_type=Path))
@click.argument("new", type=click.Path(path_type=Path))
@output_option("text", "json")
def command(old: Path, new: Path, outputs: tuple[Output, ...]) -> None:
    """Compare two models by meaning: what a review has to look at, and nothing else.

    OLD and NEW are files or folders with .amxmi files. Objects are compared by their names, wherever they stand; order without
    meaning, layout, ids and explicit defaults make no difference. Exit code 1 if there are differences.
    """
    changes = difference(load(old), load(new))
    for output in outputs:
        render = partial(write_text, changes) if output.format == "text" else partial(write_json, changes, old, new)
        output.write(render)
    sys.exit(1 if changes else 0)
