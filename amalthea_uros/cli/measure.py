"""`amuros measure`: statistics of the times in a trace."""

from __future__ import annotations

import sys
from collections import Counter
from dataclasses import replace
from pathlib import Path

import click

from amalthea_uros.cli.files import INPUT, output_path
from amalthea_uros.cli.measure_options import measure_options
from amalthea_uros.cli.output import (
    Output,
    beside_files,
    output_option,
    refuse_input,
    refuse_unwritable,
    show_findings,
    write_outputs,
)
from amalthea_uros.cli.settings_options import AssignmentType
from amalthea_uros.compare.measured.events import chain_starts
from amalthea_uros.diagnostics import Severity
from amalthea_uros.measure.series import Measurement
from amalthea_uros.services.measure import MeasureOptions, measure_file
from amalthea_uros.services.subject import system_of


@click.command("measure")
@click.argument("trace", type=INPUT, metavar="TRACE")
@measure_options
@click.option(
    "--model",
    type=INPUT,
    metavar="MODEL_OR_YAML",
    help="System of a trace of events: its chains then begin as they do in it; default: at the activation of a job.",
)
@click.option("--select", multiple=True, metavar="NAME", help="Show only this object; may be repeated.")
@click.option(
    "--histogram",
    "histograms",
    multiple=True,
    type=AssignmentType("NAME=FILE", output_path),
    help="Draw the times of an object, or another of its quantities, e.g. Task.start_to_start=period.svg; may be repeated.",
)
@output_option(Measurement)
def command(
    trace: Path,
    reading: MeasureOptions,
    model: Path | None,
    select: tuple[str, ...],
    histograms: tuple[tuple[str, Path], ...],
    outputs: tuple[Output, ...],
) -> None:
    """Measure the times in a trace: minimum, mean, maximum, jitter and percentiles.

    TRACE is a log of a CAN bus (candump .log; .asc, .blf, .trc, .mf4), whose frames at starts and ends are given by --start and --end
    or in a file; a trace of events such as .btf or a folder with a CTF trace, whose processes, runnables and chains are measured; or a
    .csv of measured values.
    The exit code is 1 if nothing was measured, or if a part of the trace is damaged.
    """
    outputs = beside_files(outputs, [("--histogram", path) for _, path in histograms])
    for path, number in Counter(path for _, path in histograms).items():
        if number > 1:
            raise click.UsageError(f"{path} is the file of {number} options; give each its own")
        refuse_input(path, str(path))
        refuse_unwritable(path)
    starts = {} if model is None else chain_starts(system_of(model))
    found = measure_file(trace, replace(reading, select=select, chain_starts=starts))
    show_findings(found.findings)
    if histograms:
        from amalthea_uros.report.result_pictures import histogram_picture
        from amalthea_uros.xmi.emf.files import FileText, write_text

        pictures = [(path, histogram_picture(found, name)) for name, path in histograms]
        for path, picture in pictures:
            write_text(path, FileText(picture))
    write_outputs(outputs, found)
    sys.exit(1 if any(finding.severity is Severity.ERROR for finding in found.findings) else 0)
