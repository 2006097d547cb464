"""What to know of measured values before they are used."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Final

from amalthea_uros._internal.plural import counted
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.measure.baselines import WITH_COST
from amalthea_uros.measure.series import Measurement, Series, TimeStatistics
from amalthea_uros.units import Time, time_text

#: Shorter times are measured too coarsely, in steps of the clock.
_FEWEST_STEPS = 10
#: A maximum so many times as long as the second longest of at least so many values is uncertain.
_FAR, _ENOUGH = 10, 20
#: Rows of a table that are lost are reported with their lines.
LOST_ROWS: Final = "MEA015"


def judged(measurement: Measurement) -> Iterator[Finding]:
    """The findings about the measured values."""
    place = Location(Path(measurement.source))
    if not any(series.statistics is not None for series in measurement.series):
        message = "nothing was measured: the trace has no complete job, interval or chain in this part"
        yield Finding("MEA005", Severity.ERROR, message, place, "Check what was recorded, and the markers.")
    seen: set[str] = set()
    for series in measurement.series:
        if series.name not in seen:
            seen.add(series.name)
            if all(finding.rule != LOST_ROWS for finding in measurement.findings):
                yield from _uncounted(series, place)
        yield from _baseline(series, place)
        yield from _outlier(series, place)
    yield from _coarse(measurement, place)


def _uncounted(series: Series, place: Location) -> Iterator[Finding]:
    counts = series.counts
    problems = {"lost": counts.lost, "duplicated": counts.duplicated, "reordered": counts.reordered}
    reported = ", ".join(f"{number:,} {what}" for what, number in problems.items() if number)
    if reported:
        severity = Severity.WARNING if counts.lost or counts.reordered else Severity.INFO
        yield Finding(
            "MEA006", severity, f"events of {series.name!r}: {reported}; they are not measured", place, object=series.name
        )


def _coarse(measurement: Measurement, place: Location) -> Iterator[Finding]:
    resolution = measurement.resolution
    shortest = {series.name: series for series in reversed(measurement.series) if series.quantity in WITH_COST}
    for series in shortest.values():
        found = series.statistics
        if resolution is not None and found is not None and 0 < found.mean < _FEWEST_STEPS * resolution:
            yield _few_steps(series, found, resolution, place)


def _few_steps(series: Series, found: TimeStatistics, resolution: Time, place: Location) -> Finding:
    error = float(100 * resolution / found.mean)
    message = (
        f"the {series.quantity.replace('_', ' ')} of {series.name!r} is about {counted(round(found.mean / resolution), 'step')} of the "
        f"clock ({time_text(resolution)}): a single value is only known to +-{error:.0f} %"
    )
    return Finding("MEA007", Severity.WARNING, message, place, "Use a finer clock, or the mean of many values.", series.name)


def _outlier(series: Series, place: Location) -> Iterator[Finding]:
    """A maximum that nothing else is near: a hang of the software is measured like that, and so is a clock that was set forward."""
    if series.values is None or series.quantity not in WITH_COST or len(series.values) < _ENOUGH:
        return
    largest = int(series.values.max())
    others = series.values[series.values < largest]
    next_ = int(others.max()) if len(others) else 0
    if next_ > 0 and largest > _FAR * next_ and len(series.values) - len(others) == 1:
        message = (
            f"the maximum of {series.name!r}, {time_text(largest)}, is more than {_FAR} times as long as all its other times "
            f"(up to {time_text(next_)})"
        )
        help_ = "Check what happened then: the software may have been late, or the clock was set, or events are missing."
        yield Finding("MEA014", Severity.WARNING, message, place, help_, series.name)


def _baseline(series: Series, place: Location) -> Iterator[Finding]:
    if series.baseline is not None and series.statistics is not None and series.statistics.min < 0:
        mean = time_text(round(series.baseline.mean))
        message = f"the mean of the baseline, {mean}, is longer than the shortest time of {series.name!r}"
        help_ = "Check that the baseline is of an empty object with the same period and on the same core."
        yield Finding("MEA008", Severity.WARNING, message, place, help_, series.name)
