"""`amuros chains`: find paths along data and triggers, and add them as event chains."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from amalthea_uros._internal.files import is_standard_output
from amalthea_uros.cli.files import INPUT, OUTPUT
from amalthea_uros.cli.output import show_findings, show_text
from amalthea_uros.report.basics.escape import output_line
from amalthea_uros.services.chains import add_path, chosen_path, find_paths


@click.command("chains")
@click.argument("model", type=INPUT, metavar="MODEL_OR_YAML")
@click.option("--from", "start", required=True, metavar="NAME", help="Process, runnable or label where paths start.")
@click.option("--to", "end", required=True, metavar="NAME", help="Process, runnable or label where paths end.")
@click.option("--add", "name", metavar="CHAIN", help="Add a path to the model as an event chain with this name.")
@click.option("--path", "number", type=int, default=1, show_default=True, help="Number of the path to add.")
@click.option(
    "-o",
    "output",
    type=OUTPUT,
    metavar="FILE",
    help="File to which the model with the event chain is written.",
)
def command(model: Path, start: str, end: str, name: str | None, number: int, output: Path | None) -> None:
    """List the paths from one process, runnable or label to another, with their end-to-end latencies.

    Each process of a path writes a label or channel that the next one reads, or triggers it. With --add, one of the paths is added
    to the model as an event chain, and the model is written to another file. Exit code 1 if there is no path.
    """
    if (name is None) != (output is None):
        raise click.UsageError("--add CHAIN and -o FILE must be given together")
    result = find_paths(model, start, end)
    show_findings(result.findings)
    if not result.paths:
        show_text(result)
        sys.exit(1)
    chosen_path(result, number)
    is_piped = output is not None and is_standard_output(output)
    show_text(result, on_error_stream=is_piped)
    if name is not None and output is not None:
        add_path(result, number, name, output)
        click.echo(output_line(f"path {number} is now the chain {name} in {output}"), err=is_piped)
