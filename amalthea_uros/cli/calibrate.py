"""`amuros calibrate`: measured values in an app.yaml."""

from __future__ import annotations

import sys
from fractions import Fraction
from pathlib import Path

import click
from click.core import ParameterSource

from amalthea_uros._internal.files import STANDARD_ERROR, resolved
from amalthea_uros.cli.files import INPUT, OUTPUT_FILE
from amalthea_uros.cli.measure_options import measure_options
from amalthea_uros.cli.output import (
    Output,
    beside_files,
    output_option,
    refuse_input,
    show_findings,
    show_text,
    write_outputs,
)
from amalthea_uros.cli.parsed import Parsed
from amalthea_uros.compare.calibration.options import CalibrationOptions, Form
from amalthea_uros.services.calibrate import Calibration, calibrate_file, parse_share
from amalthea_uros.services.file_changes import FilesDiff
from amalthea_uros.services.measure import MeasureOptions, measure_file


def _share(text: str) -> Fraction:
    return parse_share(text, "share")


@click.command("calibrate")
@click.argument("description", type=INPUT, metavar="APP_YAML")
@click.argument("traces", nargs=-1, required=True, type=INPUT, metavar="TRACE...")
@click.option(
    "-o",
    "--out",
    "target",
    type=OUTPUT_FILE,
    metavar="FILE",
    help="File to write, which may be APP_YAML; default: show a diff.",
)
@click.option("--diff", "--dry-run", "is_dry_run", is_flag=True, help="Write no file; show what would change in it.")
@click.option(
    "--as",
    "form",
    type=click.Choice([str(form) for form in Form]),
    default=str(Form.BOUNDS),
    show_default=True,
    help="Write execution times as bounds, as bounds with the mean, or as a histogram.",
)
@click.option(
    "--margin",
    type=Parsed("SHARE", _share),
    default="20%",
    show_default=True,
    help="Lower measured minima and raise measured maxima by this share; not for histograms.",
)
@click.option("--tighten", is_flag=True, help="Also narrow values of APP_YAML that allow more than was measured.")
@click.option(
    "--judge-on",
    type=Parsed("SHARE", _share),
    default="0%",
    help="Do not use the last values, e.g. 30% of them, but check that they are within what is written.",
)
@measure_options
@output_option(Calibration)
def command(
    description: Path,
    traces: tuple[Path, ...],
    target: Path | None,
    is_dry_run: bool,
    form: str,
    margin: Fraction,
    tighten: bool,
    judge_on: Fraction,
    reading: MeasureOptions,
    outputs: tuple[Output, ...],
) -> None:
    """Put measured execution times, periods and jitters into an app.yaml.

    Comments and layout of the file stay as they are, and a comment above each value says where it comes from. What the file states is
    only widened, unless --tighten is given. TRACE is anything that `amuros measure` reads. The exit code is 1 if the measurement
    refutes a value of the file.
    """
    options = CalibrationOptions(form=Form(form), margin=margin, tighten=tighten, judge_on=judge_on)
    if target is not None and resolved(target) != resolved(description):
        refuse_input(target, "-o")
    is_diff = target is None or is_dry_run
    outputs = _beside_diff(outputs) if is_diff else beside_files(outputs, [("-o", target)])
    found = calibrate_file(description, [measure_file(trace, reading) for trace in traces], options)
    show_findings(found.findings)
    if is_diff:
        show_text(FilesDiff((found.change,), "calibrated"))
    elif target is not None:
        found.write(target)
    write_outputs(outputs, found)
    sys.exit(1 if found.is_refuted else 0)


def _beside_diff(outputs: tuple[Output, ...]) -> tuple[Output, ...]:
    """The outputs of a command that writes a diff to standard output: its text for people goes to standard error."""
    if click.get_current_context().get_parameter_source("outputs") is ParameterSource.DEFAULT:
        return tuple(Output(output.format, STANDARD_ERROR) for output in outputs)
    return outputs
