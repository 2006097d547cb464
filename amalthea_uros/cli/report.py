"""`amuros report`: one page, or a summary, about the timing of a system."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from amalthea_uros._internal.files import STANDARD_OUTPUT, is_standard_output
from amalthea_uros.cli.options import (
    FAILING,
    analysis_options,
    duration_option,
    fail_on_option,
    paths_argument,
    seed_option,
    set_option,
)
from amalthea_uros.cli.output import (
    Output,
    output_option,
    refuse_input,
    refuse_unwritable,
    show_differences,
    show_line,
    write_outputs,
)
from amalthea_uros.cli.parameters import OUTPUT_FILE
from amalthea_uros.design.changes.change import Change
from amalthea_uros.report.formats import SUFFIXES, format_of
from amalthea_uros.report.wording.closing_line import closing_line
from amalthea_uros.services.report import compile_report
from amalthea_uros.timing.basics.settings import Settings

_SUFFIXES = ", ".join(SUFFIXES)


@click.command("report")
@paths_argument
@click.option(
    "-o",
    "files",
    multiple=True,
    type=OUTPUT_FILE,
    metavar="FILE",
    help=f"File to write; its suffix says the format: {_SUFFIXES}. May be repeated.",
)
@output_option("ReportContent", has_default=False)
@click.option("--title", help="Title of the report; default: the names of the files.")
@click.option(
    "--date", default="", help="Date, or any other text, shown below the title; without it the output is reproducible."
)
@set_option
@analysis_options
@duration_option("Model time of the simulation; default: up to 10 s.")
@seed_option()
@click.option("--no-simulation", is_flag=True, help="Show the analysis only.")
@fail_on_option
def report(
    paths: tuple[Path, ...],
    files: tuple[Path, ...],
    outputs: tuple[Output, ...],
    changes: tuple[Change, ...],
    settings: Settings,
    no_simulation: bool,
    fail_on: str,
    **options: Any,
) -> None:
    """Report on the timing of a system: one page with verdict, tightest requirements, pictures, findings and sources.

    MODEL_OR_YAML is an app.yaml, one or more .amxmi files, or a folder of .amxmi files. A page (.html) needs nothing outside of
    itself and can be printed; a summary (.md) fits in a comment of a CI system; .mmd and .dot have the data flow. The exit code is 1
    if a deadline, requirement or constraint is missed, an activation is lost, or a core is overloaded.
    """
    outputs = _all_outputs(files, outputs)
    content = compile_report(paths, settings, changes=changes, with_simulation=not no_simulation, **options)
    show_differences(content.differences)
    write_outputs(outputs, content)
    show_line(closing_line(content.analysis.summary))
    sys.exit(1 if content.analysis.summary.schedulable in FAILING[fail_on] else 0)


def _all_outputs(files: tuple[Path, ...], outputs: tuple[Output, ...]) -> tuple[Output, ...]:
    """The formats and files, of which each can be written; refused before work that may take long."""
    if not files and not outputs:
        raise click.UsageError("nothing is written; add -o FILE, e.g. -o report.html, or --output FORMAT")
    named = [Output("html" if is_standard_output(path) else format_of(path), _stream(path)) for path in files]
    every = (*named, *outputs)
    if len({each.path if is_standard_output(each.path) else each.path.resolve() for each in every}) < len(every):
        raise click.UsageError("two options name the same file; give each its own")
    for each in every:
        refuse_input(each.path, f"-o {each.path}" if each in named else each.option)
        refuse_unwritable(each.path)
    return every


def _stream(path: Path) -> Path:
    return STANDARD_OUTPUT if is_standard_output(path) else path
