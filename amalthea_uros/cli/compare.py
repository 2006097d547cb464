"""`amuros compare`: predictions beside what was measured."""

from __future__ import annotations

import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import click

from amalthea_uros.cli.files import INPUT, OUTPUT_FILE
from amalthea_uros.cli.measure_options import measure_options
from amalthea_uros.cli.output import (
    Output,
    beside_files,
    output_option,
    refuse_input,
    refuse_unwritable,
    show_differences,
    show_findings,
    write_outputs,
)
from amalthea_uros.cli.parsed import Parsed
from amalthea_uros.cli.settings_options import AssignmentType, set_option, settings_options
from amalthea_uros.compare.naming import FORM, Meaning, Names, parse_meaning
from amalthea_uros.compare.results import Comparison, Source
from amalthea_uros.design.changes.change import Change
from amalthea_uros.services.compare import CompareOptions, compare_files, parse_tolerance
from amalthea_uros.services.measure import MeasureOptions
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import Time, parse_duration, parse_time

_BOTH = "both"


def _overhead(text: str) -> tuple[str, Time]:
    """The process, "" for all, and the time."""
    name, _, time = text.rpartition("=")
    return name, parse_time(time)


def _uncertainty(text: str) -> Time:
    time = parse_time(text)
    if time < 0:
        raise ValueError("an uncertainty must not be negative")
    return time


@click.command("compare")
@click.argument("model", type=INPUT, metavar="MODEL_OR_YAML")
@click.argument("traces", nargs=-1, required=True, type=INPUT, metavar="TRACE...")
@click.option(
    "--tolerance",
    type=Parsed("PERCENT", parse_tolerance),
    default="20%",
    show_default=True,
    help="Largest deviation of a prediction, as a share of the measurement.",
)
@click.option(
    "--by",
    type=click.Choice([*map(str, Source), _BOTH]),
    default=_BOTH,
    show_default=True,
    help="What predicts: the bounds and means of the analysis, a simulation as long as the measurement, or both.",
)
@click.option(
    "--duration", type=Parsed("TIME", parse_duration), help="Model time of the simulation; default: that of the trace."
)
@click.option("--seed", type=click.IntRange(min=0), default=1, show_default=True, help="Seed of the simulation.")
@click.option(
    "--map",
    "renamed",
    multiple=True,
    type=AssignmentType("TRACE_NAME=MODEL_NAME", str),
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
    type=Parsed("TIME", _uncertainty),
    help="How far a measured time may be wrong; default: less than a step of the time stamps.",
)
@click.option(
    "--all", "with_all", is_flag=True, help="Show all quantities, not only the most important ones and what disagrees."
)
@click.option("--picture", type=OUTPUT_FILE, metavar="FILE", help="Draw predictions and measured distributions, as SVG.")
@set_option
@settings_options
@measure_options
@output_option(Comparison)
def command(
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
    code is 1 if a prediction is outside of the tolerance or refuted, if a limit is missed, or if nothing was compared.
    """
    outputs = beside_files(outputs, [("--picture", picture)])
    if picture is not None:
        refuse_input(picture, "--picture")
        refuse_unwritable(picture)
    options = CompareOptions(
        tolerance=tolerance,
        sources=tuple(Source) if by == _BOTH else (Source(by),),
        duration=duration,
        seed=seed,
        names=Names(renamed=dict(renamed), meanings=meanings),
        overheads=dict(overheads),
        uncertainty=uncertainty,
    )
    result = compare_files(model, traces, options, reading, settings=settings, changes=changes)
    show_findings(result.findings)
    show_differences(result.differences)
    if picture is not None:
        from amalthea_uros.report.result_pictures import comparison_picture
        from amalthea_uros.xmi.emf.files import FileText, write_text

        write_text(picture, FileText(comparison_picture(result)))
    write_outputs(outputs, replace(result, with_all=with_all))
    sys.exit(1 if result.is_failed else 0)
