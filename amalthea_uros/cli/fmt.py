"""`amuros fmt`: canonical form, as APP4MC writes it."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from amalthea_uros._internal.files import STANDARD_INPUT
from amalthea_uros.cli.files import INPUT
from amalthea_uros.cli.output import show_findings, show_text
from amalthea_uros.services.file_changes import FilesDiff
from amalthea_uros.services.format import format_files


@click.command("fmt")
@click.argument("paths", nargs=-1, required=True, type=INPUT, metavar="MODEL...")
@click.option("--check", is_flag=True, help="Write nothing; exit code 1 if a file is not in canonical form.")
@click.option("--diff", "show_diff", is_flag=True, help="Write nothing; show what would change, exit code 1 if anything would.")
def command(paths: tuple[Path, ...], check: bool, show_diff: bool) -> None:
    """Rewrite models in canonical form: as Eclipse APP4MC would save them.

    Order, indentation, number formats, explicit defaults and ids follow APP4MC; the AMALTHEA version, comments and unknown
    content are preserved. MODEL is a file or a folder with .amxmi files; with '-', standard input is written to standard output.
    """
    result = format_files(paths, write=not (check or show_diff))
    is_filter = STANDARD_INPUT in paths and result.is_written
    show_text(FilesDiff(result.changed, "canonical") if show_diff else result, on_error_stream=is_filter)
    show_findings(result.findings)
    sys.exit(2 if result.findings else 1 if result.changed and not result.is_written else 0)
