"""`amuros compare` and `amuros calibrate`: predictions beside what was measured, and measured values in an app.yaml."""

from __future__ import annotations

import sys
from dataclasses import replace
from fractions import Fraction
from functools import partial
from pathlib import Path

import click
from click.core import ParameterSource

from amalthea_uros._internal.files import STANDARD_ERROR, resolved
from amalthea_uros.cli.measure import measure_options
from amalthea_uros.cli.options import duration_option, not_negative, seed_option, set_option, settings_options
from amalthea_uros.cli.output import (
    Output,
    beside_files,
    checked_outputs,
    output_option,
    refuse_input,
    show_findings,
    show_result,
    show_text,
    write_outputs,
)
from amalthea_uros.cli.parameters import DESCRIPTION, INPUT, PICTURE, Parsed, assignment
from amalthea_uros.compare.calibration.calibration import calibrate_file
from amalthea_uros.compare.calibration.options import FIT_FORM, AgentFit, CalibrationOptions, Form, parse_fit
from amalthea_uros.compare.comparing import CompareOptions
from amalthea_uros.compare.measured.measuring import MeasureOptions, measure_file
from amalthea_uros.compare.naming import FORM, Meaning, Names, parse_meaning
from amalthea_uros.compare.results import PredictionSource
from amalthea_uros.compare.shares import parse_share, parse_tolerance
from amalthea_uros.design.changes.change import Change
from amalthea_uros.services.compare import compare_files
from amalthea_uros.services.files import FileChange, FilesDiff, save_text
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import Time, parse_time

_BOTH = "both"
_SHARE = Parsed("SHARE", partial(parse_share, what="share"))
_traces_argument = click.argument("traces", nargs=-1, required=True, type=INPUT, metavar="TRACE...")


def _overhead(text: str) -> tuple[str, Time]:
    """The process, "" for all, and the time."""
    name, _, time = text.rpartition("=")
    return name, parse_time(time)


@click.command("compare")
@click.argument("model", type=INPUT, metavar="MODEL_OR_YAML")
@_traces_argument
@click.option(
    "--tolerance",
    type=Parsed("PERCENT", parse_tolerance),
    default="20%",
    show_default=True,
    help="Largest deviation of a prediction, as a share of the measurement.",
)
@click.option(
    "--by",
    type=click.Choice([*map(str, PredictionSource), _BOTH]),
    default=_BOTH,
    show_default=True,
    help="What predicts: the bounds and means of the analysis, a simulation as long as the measurement, or both.",
)
@duration_option("Model time of the simulation; default: that of the trace.")
@seed_option()
@click.option(
    "--map",
    "renamed",
    multiple=True,
    type=assignment("TRACE_NAME=MODEL_NAME", str),
    help="Name of an object of the trace in the model; may be repeated.",
)
@click.option(
    "--as",
    "meanings",
    multiple=True,
    type=Parsed(FORM, parse_meaning),
    help="What a measured time is in the model, e.g. 'executor + control=Control_Function.response_time'; may be repeated.",
)
@click.option(
    "--overhead",
    "overheads",
    multiple=True,
    type=Parsed("[PROCESS=]TIME", _overhead),
    help="Add a time to the predicted execution and response times of all processes, or of one, e.g. 41us; may be repeated.",
)
@click.option(
    "--uncertainty",
    type=Parsed("TIME", not_negative("an uncertainty")),
    help="How far a measured time may be wrong; default: less than a step of the time stamps.",
)
@click.option(
    "--all", "with_all", is_flag=True, help="Show all quantities, not only the most important ones and what disagrees."
)
@click.option("--picture", type=PICTURE, metavar="FILE", help="Draw predictions and measured distributions, as SVG.")
@set_option
@settings_options
@measure_options
@output_option("Comparison")
def compare(
    model: Path,
    traces: tuple[Path, ...],
    tolerance: Fraction,
    by: str,
    duration: Time | None,
    seed: int,
    renamed: tuple[tuple[str, str], ...],
    meanings: tuple[Meaning, ...],
    overheads: tuple[tuple[str, Time], ...],
    uncertainty: Time | None,
    with_all: bool,
    picture: Path | None,
    changes: tuple[Change, ...],
    settings: Settings,
    reading: MeasureOptions,
    outputs: tuple[Output, ...],
) -> None:
    """Compare what the model predicts with what was measured: whether the model holds.

    TRACE is what `amuros measure` reads; several traces count as one measurement. Deviations are shares of the measurement. A measured
    value beyond a bound of the analysis refutes the model, whatever the tolerance. Limits are judged by the measured values. The exit
    code is 1 if a prediction is outside of the tolerance or refuted, if a limit is missed, if nothing was compared, or if a part of the
    measurement is damaged.
    """
    outputs = checked_outputs(outputs, [("--picture", picture)])
    options = CompareOptions(
        tolerance=tolerance,
        sources=tuple(PredictionSource) if by == _BOTH else (PredictionSource(by),),
        duration=duration,
        seed=seed,
        names=Names(renamed=dict(renamed), meanings=meanings),
        overheads=dict(overheads),
        uncertainty=uncertainty,
    )
    result = compare_files(model, traces, options, reading, settings=settings, changes=changes)
    if picture is not None:
        from amalthea_uros.report.result_pictures import comparison_picture

        save_text(picture, comparison_picture(result))
    show_result(replace(result, with_all=with_all), outputs)
    sys.exit(1 if result.is_failed else 0)


@click.command("calibrate")
@click.argument("description", type=INPUT, metavar="APP_YAML")
@_traces_argument
@click.option(
    "-o",
    "--out",
    "target",
    type=DESCRIPTION,
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
    type=_SHARE,
    default="20%",
    show_default=True,
    help="Lower measured minima and raise measured maxima by this share; not for histograms.",
)
@click.option("--tighten", is_flag=True, help="Also narrow values of APP_YAML that allow more than was measured.")
@click.option(
    "--judge-on",
    type=_SHARE,
    default="0%",
    help="Do not use the last values, e.g. 30% of them, but check that they are within what is written.",
)
@click.option(
    "--fit",
    "fits",
    multiple=True,
    type=Parsed(FIT_FORM, parse_fit),
    help="Choose times in the agent so that measured round trips result, e.g. agent=round-trip; may be repeated.",
)
@measure_options
@output_option("Calibration")
def calibrate(
    description: Path,
    traces: tuple[Path, ...],
    target: Path | None,
    is_dry_run: bool,
    form: str,
    margin: Fraction,
    tighten: bool,
    judge_on: Fraction,
    fits: tuple[AgentFit, ...],
    reading: MeasureOptions,
    outputs: tuple[Output, ...],
) -> None:
    """Put measured execution times, periods and jitters into an app.yaml.

    Comments and layout of the file stay as they are, and a comment above each value says where it comes from. What the file states is
    only widened, unless --tighten is given. TRACE is anything that `amuros measure` reads. The exit code is 1 if the measurement
    refutes a value of the file.
    """
    options = CalibrationOptions(form=Form(form), margin=margin, tighten=tighten, judge_on=judge_on, fits=fits)
    if target is not None and resolved(target) != resolved(description):
        refuse_input(target, "-o")
    is_diff = target is None or is_dry_run
    outputs = _beside_diff(outputs) if is_diff else beside_files(outputs, [("-o", target)])
    found = calibrate_file(description, [measure_file(trace, reading) for trace in traces], options)
    show_findings(found.findings)
    if is_diff:
        show_text(FilesDiff((FileChange(found.path, found.before, found.text),), "calibrated"))
    elif target is not None:
        found.write(target)
    write_outputs(outputs, found)
    sys.exit(1 if found.is_refuted else 0)


def _beside_diff(outputs: tuple[Output, ...]) -> tuple[Output, ...]:
    """The outputs of a command that writes a diff to standard output: its text for people goes to standard error."""
    if click.get_current_context().get_parameter_source("outputs") is ParameterSource.DEFAULT:
        return tuple(Output(output.format, STANDARD_ERROR) for output in outputs)
    return outputs
