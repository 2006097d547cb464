"""`amuros diff`: two models compared by meaning."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from amalthea_uros.cli.files import INPUT
from amalthea_uros.cli.output import Output, output_option, show_findings, write_outputs
from amalthea_uros.services.diff import DiffResult, diff


@click.command("diff")
@click.argument("old", type=INPUT)
@click.argument("new", type=INPUT)
@click.option("--impact", "with_impact", is_flag=True, help="Also analyze both models, and compare loads, times and verdicts.")
@output_option(DiffResult)
def command(old: Path, new: Path, with_impact: bool, outputs: tuple[Output, ...]) -> None:
    """Compare two models by meaning: only what a review has to look at.

    OLD and NEW are files, folders with .amxmi files, or an app.yaml, whose model is built in memory. Objects are compared by their
    names, in whatever file they are; order without meaning, layout, ids and explicit defaults make no difference. Models of different
    AMALTHEA versions are migrated to the newest one in memory. What changes the timing is shown first, in words such as period,
    priority and execution time. Exit code 1 if there are differences.
    """
    result = diff(old, new, with_impact=with_impact)
    show_findings(result.findings)
    write_outputs(outputs, result)
    sys.exit(1 if result.changes else 0)
