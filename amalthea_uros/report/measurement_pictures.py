"""Pictures of measurements as SVG."""

from __future__ import annotations

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.measure.series import MeasuredKind, Measurement, Series
from amalthea_uros.names import listed, require
from amalthea_uros.report.documents import measurement as measured
from amalthea_uros.report.pictures.histogram import HistogramPicture, HistogramSeries, histogram
from amalthea_uros.report.pictures.histogram_marks import Mark, MarkKind


def histogram_picture(measurement: Measurement, name: str) -> str:
    """The values of a series.

    Parameters
    ----------
    name : of an object, for its first series, or with a quantity such as "Task.start_to_start"

    Raises
    ------
    InvalidArgumentError : there is no such series, or its single values are not known.
    """
    series = _named(measurement, name)
    found = measured.histogram_of(series, measurement.resolution)
    if found is None or series.statistics is None:
        raise InvalidArgumentError(f"the single values of {name!r} are not known, so there is no histogram")
    words = series.quantity.replace("_", " ")
    statistics = series.statistics
    marks = [Mark("min", statistics.min), Mark("mean", statistics.mean), Mark("max", statistics.max)]
    if measured.P99 in statistics.percentiles:
        marks.append(Mark("p99", statistics.percentiles[measured.P99]))
    if series.period is not None:
        marks.append(Mark("period", series.period, MarkKind.LIMIT))
    edges = tuple(map(int, found.edges))
    things = "jobs" if series.kind is MeasuredKind.PROCESS else "values"
    title = f"{measurement.source}: {words} of {series.name}"
    return histogram(HistogramPicture(title, edges, (HistogramSeries("measured", found.counts),), tuple(marks), words, things))


def _named(measurement: Measurement, name: str) -> Series:
    first = next((series for series in measurement.series if series.name == name), None)
    if first is not None:
        return first
    of, _, quantity = name.rpartition(".")
    require("measured object", [of or name], dict.fromkeys(series.name for series in measurement.series))
    found = measurement.find(of, quantity)
    if found is None:
        known = listed([series.quantity for series in measurement.series if series.name == of])
        raise InvalidArgumentError(f"{quantity!r} of {of!r} was not measured; known: {known}")
    return found
