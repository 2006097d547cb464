"""What markers in a log of a CAN bus measure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from amalthea_uros._internal.plural import counted
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.measure.markers import Marker, Measurable
from amalthea_uros.measure.series import Measurement, Series
from amalthea_uros.measure.window import MeasurementWindow
from amalthea_uros.names import listed

if TYPE_CHECKING:
    from amalthea_uros.measure.markers import MarkerCollector, MarkerOccurrences

#: With fewer than 1 in so many of the frames of the busiest bus, frames are strays of a damaged log.
_STRAY = 100
#: With more than 1 gap in so many frames, damage that leaves a line valid is to be expected, too.
_FEW = 1000
_ADVICE = (
    "a CAN log has no names of tasks; add --start ID and --end ID of the frames at the start and at the end, or --markers FILE with "
    "those of several objects"
)


def measured_frames(path: Path, objects: Sequence[Measurable], window: MeasurementWindow, channel: str | None) -> Measurement:
    """Measure the objects in a log.

    Raises
    ------
    ReadError : the file cannot be read.
    InvalidArgumentError : there are no objects, or a package is missing.
    """
    from amalthea_uros.trace.can.logs import open_can_log

    if not objects:
        next(iter(open_can_log(path)), None)  # that a file cannot be read is said first
        raise InvalidArgumentError(_ADVICE)
    from amalthea_uros.measure.can_series import markers_of
    from amalthea_uros.measure.markers import MarkerCollector
    from amalthea_uros.measure.window import resolution_of

    log = open_can_log(path, channel=channel)
    markers = list(dict.fromkeys(marker for item in objects for marker in markers_of(item)))
    found = MarkerCollector(markers, window)
    found.add_all(log)
    occurrences = found.occurrences
    series: list[Series] = []
    findings: list[Finding] = [*log.findings]
    for item in objects:
        own, told = _measured_object(item, markers, found, occurrences, Location(path))
        series += own
        findings += told
    if series and found.gaps * _FEW > found.frames:
        findings.append(_damaged(found, Location(path)))
    return Measurement(
        source=str(path),
        format="CAN log",
        digest="",
        duration=0 if found.first is None or found.last is None else found.last - found.first,
        resolution=resolution_of(occurrences.time, log.resolution),
        series=tuple(series),
        findings=tuple(findings),
    )


def _measured_object(
    item: Measurable, markers: Sequence[Marker], log: MarkerCollector, found: MarkerOccurrences, place: Location
) -> tuple[list[Series], list[Finding]]:
    """The series of an object, on each bus where it occurs, and what to tell of it."""
    import numpy as np

    from amalthea_uros.measure.can_series import MeasuredObject, markers_of, measure_object

    wanted = markers_of(item)
    numbers = [markers.index(marker) for marker in wanted]
    own = found.where(np.isin(found.marker, numbers))
    own = replace(own, marker=(own.marker == numbers[-1]).astype(np.int64) if len(numbers) > 1 else np.zeros_like(own.marker))
    present = set(own.marker.tolist())
    findings = [_missing(item, marker, log, place) for number, marker in enumerate(wanted) if number not in present]
    found_on, numbers_on = np.unique(own.channel, return_counts=True)
    is_stray = numbers_on * _STRAY < numbers_on.max(initial=0)
    if is_stray.any():
        findings.append(_stray(item, int(numbers_on[is_stray].sum()), int(np.count_nonzero(is_stray)), place))
        # Where a name is damaged a frame of another bus is missing.
        own = replace(own, segment=own.segment + np.cumsum(np.isin(own.channel, found_on[is_stray])))
    buses = found_on[~is_stray].tolist()
    parts: list[MeasuredObject] = []
    for bus in buses:
        measured = measure_object(item, own.where(own.channel == bus))
        name = item.name if len(buses) == 1 else f"{log.channels[bus]}:{item.name}"
        parts.append(replace(measured, series=tuple(replace(each, name=name) for each in measured.series)))
    if len(buses) > 1:
        findings.append(_several_buses(item, [log.channels[bus] for bus in buses], place))
    findings += (_undecoded(item, part.undecoded, place) for part in parts if part.undecoded)
    uncertain = sum(log.uncertain.get(number, 0) for number in numbers)
    return [_with_uncertain(series, uncertain) for part in parts for series in part.series], findings


def _with_uncertain(series: Series, number: int) -> Series:
    """A series that also counts the frames at steps back of the clock."""
    return replace(series, counts=replace(series.counts, reordered=series.counts.reordered + number))


def _missing(item: Measurable, marker: Marker, log: MarkerCollector, place: Location) -> Finding:
    other = Marker(marker.identifier ^ (1 << 31), marker.data, marker.channel)
    frequent = sorted(log.seen, key=lambda key: -log.seen[key])
    known = listed([str(Marker(identifier)) for _, identifier in dict.fromkeys(frequent)])
    seen = {identifier for _, identifier in log.seen}
    if other.identifier in seen:
        help_ = f"The log has {other} with the other length of identifiers: write all eight digits of one with 29 bits."
    elif marker.identifier in seen:
        help_ = "The log has frames with this identifier, but not with these bytes or on this bus."
    else:
        help_ = f"Check the identifier; the log has {known}." if known else "The log has no frames in this part."
    return Finding("MEA001", Severity.ERROR, f"no frame {marker} of {item.name!r} in the log", place, help_, item.name)


def _damaged(log: MarkerCollector, place: Location) -> Finding:
    gaps, frames = counted(log.gaps, "damaged or missing part"), counted(log.frames, "frame")
    message = f"{gaps} in {frames}: a wrong digit in a time cannot be recognised, so a minimum or maximum may be wrong"
    advice = "Copy or record the log again; else rely on means and percentiles only."
    return Finding("MEA013", Severity.WARNING, message, place, advice)


def _stray(item: Measurable, number: int, buses: int, place: Location) -> Finding:
    what = f"{counted(number, 'frame')} of {item.name!r} on {counted(buses, 'bus')}"
    message = f"{what} with less than 1 in {_STRAY} of those of the busiest; these are not measured"
    return Finding("MEA002", Severity.WARNING, message, place, "Choose the bus: --channel NAME.", item.name)


def _several_buses(item: Measurable, names: Sequence[str], place: Location) -> Finding:
    message = f"the frames of {item.name!r} are on {len(names)} buses: {', '.join(names)}; each is measured separately"
    return Finding("MEA002", Severity.WARNING, message, place, f"Choose the bus: --channel {names[0]}.", item.name)


def _undecoded(item: Measurable, number: int, place: Location) -> Finding:
    message = f"{number:,} frames of {item.name!r} do not have the value or number that they should; they are not used"
    return Finding(
        "MEA003", Severity.WARNING, message, place, "Check the bytes or the signal, and that the DBC fits.", item.name
    )
