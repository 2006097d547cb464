"""What was measured in a trace."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TypeVar

from amalthea_uros._internal.one_or_several import one_or_several
from amalthea_uros._internal.paths import StrPath
from amalthea_uros.compare.measured.columns import parse_column, parse_unit, parse_valid_rows
from amalthea_uros.compare.measured.events import begins_of
from amalthea_uros.compare.measured.measuring import MeasureOptions, measure_file
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.measure.begins import ModelBegins
from amalthea_uros.measure.markers import parse_marker
from amalthea_uros.measure.series import Measurement
from amalthea_uros.measure.window import MeasurementWindow
from amalthea_uros.services.inputs import as_paths
from amalthea_uros.services.subject import Subject, open_system
from amalthea_uros.timing.basics.stated_times import TimeLike, stated_time

T = TypeVar("T")


def measure(
    trace: StrPath,
    *,
    markers: StrPath | None = None,
    start: str | None = None,
    end: str | None = None,
    name: str = "interval",
    counter: str | None = None,
    dbc: StrPath | None = None,
    channel: str | None = None,
    baseline: str | Mapping[str, str] | None = None,
    baseline_from: StrPath | None = None,
    period: TimeLike | None = None,
    window: tuple[TimeLike, TimeLike | None] = (0, None),
    select: Iterable[str] = (),
    model: Subject | None = None,
    columns: Iterable[str] = (),
    unit: str | None = None,
    valid_rows: str | None = None,
) -> Measurement:
    """Measure the times in a trace: of processes, runnables and chains, or of what markers in a CAN log delimit.

    Parameters
    ----------
    trace : a CAN log (candump .log; .asc, .blf, .trc with `pip install amuros[can]`, .mf4 also with asammdf), a trace of events
        such as .btf, or measured values as .csv
    markers : a YAML file with the markers of a CAN log by the names of what they delimit
    start, end, name : the markers of one object instead, e.g. "0x18000001", and its name
    counter : where the number of the job is in the payload of both, e.g. "byte 0", or a signal, e.g. "Debug.Counter"
    dbc : the description of the messages, for signals
    channel : the only bus that is used, e.g. "can0"
    baseline : the name of an empty object, whose times are subtracted from those of all others; or objects with theirs
    baseline_from : another trace with the empty objects
    period : the standard period; the deviation of the distances of starts from it is the jitter of AUTOSAR
    window : the part of the trace that is measured, from its first event on
    select : the objects of the result; by default all
    model : what describes the system of a trace of events, so that chains begin as they do in it; by default, at the activation of the
        job with their first step
    columns : what the columns of a table are, e.g. "rtt_ms=round-trip" or "reply_ns - request_ns=round-trip"
    unit : of the columns whose header names none, e.g. "ms"
    valid_rows : the rows of the table that have values; by default "status=ok" if there is such a column. Others count as lost

    Raises
    ------
    ReadError : a file cannot be read, or something in the markers is wrong.
    InvalidArgumentError : an option that cannot be right, or a package that is missing.
    """
    options = MeasureOptions(
        columns=tuple(_given(parse_column, each) for each in one_or_several(columns)),
        unit=None if unit is None else _given(parse_unit, unit),
        valid_rows=None if valid_rows is None else _given(parse_valid_rows, valid_rows),
        markers=None if markers is None else Path(markers),
        start=None if start is None else parse_marker(start),
        end=None if end is None else parse_marker(end),
        name=name,
        counter=counter,
        dbc=None if dbc is None else Path(dbc),
        channel=channel,
        baselines={} if baseline is None else {"": baseline} if isinstance(baseline, str) else dict(baseline),
        baseline_from=None if baseline_from is None else Path(baseline_from),
        period=None if period is None else stated_time("the period", period),
        window=MeasurementWindow(
            stated_time("the start of the window", window[0]),
            None if window[1] is None else stated_time("the end of the window", window[1]),
        ),
        select=one_or_several(select),
        begins=ModelBegins() if model is None else begins_of(open_system(model).system),
    )
    return measure_file(as_paths(trace)[0], options)


def _given(parse: Callable[[str], T], text: str) -> T:
    """The meaning of a text that was given to a function."""
    try:
        return parse(text)
    except ValueError as error:
        raise InvalidArgumentError(str(error)) from None
