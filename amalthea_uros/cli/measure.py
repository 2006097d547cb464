"""`amuros measure`: statistics of the times in a trace, and the options that say how a trace is measured."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from functools import wraps
from pathlib import Path
from typing import Any

import click

from amalthea_uros.cli.options import all_of, raw_names_option
from amalthea_uros.cli.output import Output, checked_outputs, output_option, show_findings, write_outputs
from amalthea_uros.cli.parameters import INPUT, Parsed, assignment, picture_path
from amalthea_uros.compare.measured.columns import FORM as COLUMN_FORM
from amalthea_uros.compare.measured.columns import VALID_FORM, parse_column, parse_unit, parse_valid_rows
from amalthea_uros.compare.measured.events import begins_of
from amalthea_uros.compare.measured.measuring import MeasureOptions, measure_file
from amalthea_uros.diagnostics import Severity
from amalthea_uros.measure.begins import ModelBegins
from amalthea_uros.measure.markers import FORM, parse_marker
from amalthea_uros.measure.window import MeasurementWindow
from amalthea_uros.services.files import save_text
from amalthea_uros.services.subject import open_system
from amalthea_uros.units import Time, parse_duration, parse_time

_MARKER = Parsed(FORM, parse_marker)
_TIME = Parsed("TIME", parse_time)

_OPTIONS = all_of(
    (
        click.option("--start", type=_MARKER, help="Frame of a CAN log at the start of what is measured, e.g. 0x18000001."),
        click.option(
            "--end", type=_MARKER, help="Frame at its end, e.g. 0x18000002, or can0:123#01 for a bus and first bytes."
        ),
        click.option("--name", default="interval", show_default=True, help="Name of what --start and --end delimit."),
        click.option(
            "--counter", metavar="PLACE", help="Number of the job in the payload of both, e.g. 'byte 0' or Message.Signal."
        ),
        click.option(
            "--markers", type=INPUT, metavar="FILE", help="YAML file with the frames of several objects by their names."
        ),
        click.option("--dbc", type=INPUT, metavar="FILE", help="DBC file with the signals that --markers or --counter name."),
        click.option("--channel", metavar="BUS", help="Use only the frames of this bus of a CAN log, e.g. can0."),
        click.option(
            "--column",
            "columns",
            multiple=True,
            type=Parsed(COLUMN_FORM, parse_column),
            help="What a column of a table is, e.g. 'rtt_ms=round-trip', or the difference of two; may be repeated.",
        ),
        click.option("--unit", type=Parsed("UNIT", parse_unit), help="Unit of columns whose header names none, e.g. ms."),
        click.option(
            "--valid",
            "valid_rows",
            type=Parsed(VALID_FORM, parse_valid_rows),
            help="Rows of a table that have values; default: status=ok if there is such a column. Others count as lost.",
        ),
        click.option(
            "--empty",
            "baselines",
            multiple=True,
            metavar="[OBJECT=]EMPTY",
            help="Subtract the times of an empty object from those of all others, or of one; may be repeated.",
        ),
        click.option(
            "--empty-from",
            "baseline_from",
            type=INPUT,
            metavar="TRACE",
            help="Trace with the empty objects; default: the same one.",
        ),
        click.option(
            "--period",
            type=Parsed("TIME", parse_duration),
            help="Standard period; shows the largest deviation of the distances from it.",
        ),
        click.option("--from", "start_time", type=_TIME, help="Measure from this time after the first event on, e.g. 10s."),
        click.option("--to", "end_time", type=_TIME, help="Measure only what is before this time after the first event."),
        click.option("--skip", type=_TIME, help="Leave out the start-up: the same as --from."),
    )
)
#: The options that are passed on as they are.
_AS_GIVEN = (
    "start",
    "end",
    "name",
    "counter",
    "markers",
    "dbc",
    "channel",
    "baseline_from",
    "period",
    "columns",
    "unit",
    "valid_rows",
)


def measure_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command these options; it receives them as its parameter `reading`."""

    @wraps(function)
    def with_options(
        *, baselines: tuple[str, ...], start_time: Time | None, end_time: Time | None, skip: Time | None, **others: Any
    ) -> None:
        if start_time is not None and skip is not None:
            raise click.UsageError("--skip is the same as --from; use only one of them")
        reading = MeasureOptions(
            **{name: others.pop(name) for name in _AS_GIVEN},
            baselines={name: empty for name, _, empty in (text.rpartition("=") for text in baselines)},
            window=MeasurementWindow(start_time or skip or 0, end_time),
        )
        function(reading=reading, **others)

    return _OPTIONS(with_options)


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
    type=assignment("NAME=FILE", picture_path),
    help="Draw the times of an object, or another of its quantities, e.g. Task.start_to_start=period.svg; may be repeated.",
)
@raw_names_option
@output_option("Measurement")
def measure(
    trace: Path,
    reading: MeasureOptions,
    model: Path | None,
    select: tuple[str, ...],
    histograms: tuple[tuple[str, Path], ...],
    outputs: tuple[Output, ...],
) -> None:
    """Measure the times in a trace: minimum, mean, maximum, jitter and percentiles.

    TRACE is a log of a CAN bus (candump .log; .asc, .blf, .trc, .mf4), whose frames at starts and ends are given by --start and --end
    or in a file; a trace of events such as .btf or a folder with a CTF trace, whose processes, runnables and chains are measured; a
    .csv of measured values; or a table of which --column says what its columns are.
    The exit code is 1 if nothing was measured, or if a part of the trace is damaged.
    """
    outputs = checked_outputs(outputs, [("--histogram", path) for _, path in histograms])
    begins = ModelBegins() if model is None else begins_of(open_system(model).system)
    found = measure_file(trace, replace(reading, select=select, begins=begins))
    show_findings(found.findings)
    if histograms:
        from amalthea_uros.report.result_pictures import histogram_picture

        for path, picture in [(path, histogram_picture(found, name)) for name, path in histograms]:
            save_text(path, picture)
    write_outputs(outputs, found)
    sys.exit(1 if any(finding.severity is Severity.ERROR for finding in found.findings) else 0)
