"""The times in a trace of any kind: as options say, with baselines subtracted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.compare.measured.adjusted import net, with_period
from amalthea_uros.compare.measured.columns import TableColumn, ValidRows
from amalthea_uros.compare.measured.events import measured_events
from amalthea_uros.compare.measured.frames import measured_frames
from amalthea_uros.compare.measured.marker_files import counter_of, read_markers
from amalthea_uros.compare.measured.ros_reports import is_ros_report, measured_report
from amalthea_uros.compare.measured.signals import Signals
from amalthea_uros.compare.measured.tables import measured_table
from amalthea_uros.compare.measured.values import is_value_table, measured_values
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.measure.baselines import names_of
from amalthea_uros.measure.begins import ModelBegins
from amalthea_uros.measure.findings import judged
from amalthea_uros.measure.markers import Marker, MarkerChain, MarkerPair, Measurable, refuse_overlap
from amalthea_uros.measure.series import Measurement
from amalthea_uros.measure.window import MeasurementWindow
from amalthea_uros.names import require
from amalthea_uros.trace.can.logs import is_can_log
from amalthea_uros.trace.files import digest_of
from amalthea_uros.trace.readers import format_of
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasureOptions:
    """How a trace is measured.

    Attributes
    ----------
    markers : a file that names objects and their markers in CAN logs
    start, end, name, counter : a single object of a CAN log
    dbc : the file that describes the messages of the bus
    channel : the only bus of a CAN log that is used
    baselines : objects, and the empty ones whose times are subtracted from theirs; "" stands for all others
    baseline_from : another trace, in which the empty objects are
    period : the standard period, from which the distances of starts deviate
    window : the part of the trace that is measured
    select : the only objects of the result; empty: all
    columns : the quantities of a table that has a column for each
    valid_rows : the rows of the table that have values; None: those with the status "ok", if the table has a column "status"
    unit : of the columns whose header names none, in picoseconds
    begins : with what the jobs and chains of the model begin, which `events.begins_of` finds in it
    """

    markers: Path | None = None
    start: Marker | None = None
    end: Marker | None = None
    name: str = "interval"
    counter: str | None = None
    dbc: Path | None = None
    channel: str | None = None
    baselines: Mapping[str, str] = field(default_factory=dict)
    baseline_from: Path | None = None
    period: Time | None = None
    window: MeasurementWindow = field(default_factory=MeasurementWindow)
    select: tuple[str, ...] = ()
    columns: tuple[TableColumn, ...] = ()
    valid_rows: ValidRows | None = None
    unit: Time | None = None
    begins: ModelBegins = field(default_factory=ModelBegins)

    def __post_init__(self) -> None:
        if (self.start is None) != (self.end is None):
            missing, given = ("end", "start") if self.end is None else ("start", "end")
            raise InvalidArgumentError(f"an interval needs two markers; add --{missing} to --{given}")
        if self.start is not None and self.end is not None:
            try:
                refuse_overlap(self.start, self.end)
            except ValueError as error:
                raise InvalidArgumentError(str(error)) from None
        if self.counter is not None and self.start is None:
            raise InvalidArgumentError(
                "a counter belongs to a start and an end; add --start and --end, or state it in the markers"
            )
        if not self.columns and (self.valid_rows is not None or self.unit is not None):
            raise InvalidArgumentError("which rows are valid, and the unit, belong to the columns of a table; add --column")
        if self.baseline_from is not None and not self.baselines and self.markers is None:
            raise InvalidArgumentError("a trace with empty objects needs the name of one; add --empty NAME")


def measure_file(path: Path, options: MeasureOptions) -> Measurement:
    """Measure the times in a trace.

    Raises
    ------
    ReadError : a file cannot be read, or something in the markers is wrong.
    InvalidArgumentError : an option that cannot be right, or a package that is missing.
    """
    objects = _objects(options)
    found = _measured(path, objects, options)
    baselines = {item.name: item.baseline for item in objects if not isinstance(item, MarkerChain) and item.baseline}
    baselines |= options.baselines
    if baselines:
        from_trace = found if options.baseline_from is None else _measured(options.baseline_from, objects, options)
        known = {item.name for item in objects} | {name for each in (found, from_trace) for name in names_of(each.series)}
        if known:
            require("object", [*options.baselines.values(), *filter(None, options.baselines)], known)
        found = net(found, from_trace, baselines)
    if options.period is not None:
        found = replace(found, series=tuple(with_period(series, options.period) for series in found.series))
    if options.select:
        require("measured object", options.select, dict.fromkeys(series.name for series in found.series))
        found = replace(found, series=tuple(series for series in found.series if series.name in options.select))
    return replace(found, findings=(*found.findings, *judged(found)))


def _objects(options: MeasureOptions) -> tuple[Measurable, ...]:
    signals = Signals(options.dbc)
    objects: tuple[Measurable, ...] = ()
    if options.markers is not None:
        objects = read_markers(options.markers, signals)
    if options.start is not None and options.end is not None:
        counter = None if options.counter is None else counter_of(options.counter, signals)
        objects = (*objects, MarkerPair(name=options.name, start=options.start, end=options.end, counter=counter))
    return objects


def _measured(path: Path, objects: Sequence[Measurable], options: MeasureOptions) -> Measurement:
    if options.columns:
        if objects:
            raise InvalidArgumentError("a table has columns, and no frames with markers; omit one of both")
        found = measured_table(path, options.columns, options.valid_rows, options.unit, options.window)
    elif is_can_log(path) or (objects and not _is_other_trace(path)):
        found = measured_frames(path, objects, options.window, options.channel)
    elif objects:
        raise InvalidArgumentError(f"{path.name!r} is not a log of a CAN bus, so it has no frames with markers; omit them")
    elif is_ros_report(path):
        found = measured_report(path, options.name, options.window)
    elif is_value_table(path):
        found = measured_values(path, options.window)
    else:
        found = measured_events(path, options.window, options.begins)
    return replace(found, digest=digest_of(path))


def _is_other_trace(path: Path) -> bool:
    return format_of(path) is not None or is_value_table(path) or is_ros_report(path)
