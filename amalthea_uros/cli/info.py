"""`amuros info`: the content of a model."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from amalthea_uros.cli.files import INPUT
from amalthea_uros.cli.output import Output, output_option, show_findings, write_outputs
from amalthea_uros.diagnostics import Severity
from amalthea_uros.services.info import InfoResult, info


@click.command("info")
@click.argument("paths", nargs=-1, required=True, type=INPUT, metavar="MODEL_OR_YAML...")
@click.option("--schema", is_flag=True, help="Also validate each file against the XML schema of its version.")
@output_option(InfoResult)
def command(paths: tuple[Path, ...], schema: bool, outputs: tuple[Output, ...]) -> None:
    """Show the content of a model.

    This includes the version, cores with their clocks and schedulers, tasks and ISRs with their activations, event chains, and the
    number of objects by class. MODEL_OR_YAML is an app.yaml, whose model is built in memory, a file, or a folder with .amxmi files;
    several files make one model.

    Problems found while reading the files are reported on standard error. Exit code 1 if one of them is an error.
    """
    result = info(paths, schema)
    show_findings(result.findings)
    write_outputs(outputs, result)
    sys.exit(1 if any(finding.severity is Severity.ERROR for finding in result.findings) else 0)
