"""The options that say how a trace is measured; commands that read traces share them."""

from __future__ import annotations

from collections.abc import Callable
from functools import reduce, wraps
from pathlib import Path
from typing import Any

import click

from amalthea_uros.cli.files import INPUT
from amalthea_uros.cli.parsed import Parsed
from amalthea_uros.measure.markers import FORM, Marker, parse_marker
from amalthea_uros.measure.window import MeasurementWindow
from amalthea_uros.services.measure import MeasureOptions
from amalthea_uros.units import Time, parse_duration, parse_time

_MARKER = Parsed(FORM, parse_marker)
_TIME = Parsed("TIME", parse_time)

_OPTIONS = (
    click.option("--start", type=_MARKER, help="Frame of a CAN log at the start of what is measured, e.g. 0x18000001."),
    click.option("--end", type=_MARKER, help="Frame at its end, e.g. 0x18000002, or can0:123#01 for a bus and first bytes."),
    click.option("--name", default="interval", show_default=True, help="Name of what --start and --end delimit."),
    click.option(
        "--counter", metavar="PLACE", help="Number of the job in the payload of both, e.g. 'byte 0' or Message.Signal."
    ),
    click.option("--markers", type=INPUT, metavar="FILE", help="YAML file with the frames of several objects by their names."),
    click.option("--dbc", type=INPUT, metavar="FILE", help="DBC file with the signals that --markers or --counter name."),
    click.option("--channel", metavar="BUS", help="Use only the frames of this bus of a CAN log, e.g. can0."),
    click.option(
        "--baseline",
        "baselines",
        multiple=True,
        metavar="[OBJECT=]EMPTY",
        help="Subtract the times of an empty object from those of all others, or of one; may be repeated.",
    ),
    click.option("--baseline-from", type=INPUT, metavar="TRACE", help="Trace with the empty objects; default: the same one."),
    click.option(
        "--period",
        type=Parsed("TIME", parse_duration),
        help="Standard period; shows the largest deviation of the distances from it.",
    ),
    click.option("--from", "start_time", type=_TIME, help="Measure from this time after the first event on, e.g. 10s."),
    click.option("--to", "end_time", type=_TIME, help="Measure only what is before this time after the first event."),
    click.option("--skip", type=_TIME, help="Leave out the start-up: the same as --from."),
)


def measure_options(function: Callable[..., None]) -> Callable[..., None]:
    """Give a command these options; it receives them as its parameter `reading`."""

    @wraps(function)
    def with_options(
        *,
        start: Marker | None,
        end: Marker | None,
        name: str,
        counter: str | None,
        markers: Path | None,
        dbc: Path | None,
        channel: str | None,
        baselines: tuple[str, ...],
        baseline_from: Path | None,
        period: Time | None,
        start_time: Time | None,
        end_time: Time | None,
        skip: Time | None,
        **others: Any,
    ) -> None:
        if start_time is not None and skip is not None:
            raise click.UsageError("--skip is the same as --from; use only one of them")
        reading = MeasureOptions(
            markers=markers,
            start=start,
            end=end,
            name=name,
            counter=counter,
            dbc=dbc,
            channel=channel,
            baselines=dict(_baseline(text) for text in baselines),
            baseline_from=baseline_from,
            period=period,
            window=MeasurementWindow(start_time or skip or 0, end_time),
        )
        function(reading=reading, **others)

    return reduce(lambda decorated, option: option(decorated), reversed(_OPTIONS), with_options)


def _baseline(text: str) -> tuple[str, str]:
    name, _, empty = text.rpartition("=")
    return name, empty
