"""`amuros info`: what is in a model."""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path

import click

from amalthea_uros.cli.output import Output, output_option
from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.summary import summarise
from amalthea_uros.report.info import write_json, write_text
from amalthea_uros.report.terminal import Terminal
from amalthea_uros.xmi.load import load


@click.command("info")
@click.argument("paths", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="MODEL...")
@click.option("--schema", is_flag=True, help="Also validate each file against the XML schema of its version.")
@output_option("text", "json")
def command(paths: tuple[Path, ...], schema: bool, outputs: tuple[Output, ...]) -> None:
    """Show what is in a model.

    Version, cores with their clocks and schedulers, tasks and ISRs with what activates them, event chains, and how many objects
    of which class. MODEL is a file or a folder with .amxmi files; several make one model.

    What was odd when reading is told on standard error. Exit code 1 if there is an error among that.
    """
    model = load(*paths)
    findings = list(model.findings)
    if schema:
        from amalthea_uros.xmi.schema_findings import schema_findings

        findings += [finding for document in model.documents for finding in schema_findings(document)]
    Terminal(sys.stderr).findings(findings)
    summary = summarise(model)
    for output in outputs:
        output.write(partial(write_json if output.format == "json" else write_text, summary))
    sys.exit(1 if any(finding.severity is Severity.ERROR for finding in findings) else 0)
