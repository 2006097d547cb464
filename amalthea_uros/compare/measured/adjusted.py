"""Series after baselines were subtracted and a standard period was stated."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.measure.baselines import Baselines
from amalthea_uros.measure.series import Measurement, Series
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.units import Time


def net(found: Measurement, empty: Measurement, baselines: Mapping[str, str]) -> Measurement:
    """A measurement with the times of the empty objects subtracted from those of the other objects; a missing one is reported."""
    subtracted = Baselines(baselines, empty.series)
    series = tuple(map(subtracted.net, found.series))
    place = Location(Path(empty.source))
    findings = (
        Finding(
            "MEA012",
            Severity.ERROR,
            f"{name!r} was not measured; nothing is subtracted from the times of other objects",
            place,
            _ADVICE,
        )
        for name in subtracted.missing
    )
    return replace(found, series=series, findings=(*found.findings, *findings))


_ADVICE = "Check the markers of the empty object, or give the trace with it: --empty-from TRACE."


def with_period(series: Series, period: Time) -> Series:
    """A series of distances with the standard period, if none is stated for it."""
    is_distance = series.quantity in (JobMetric.START_TO_START, JobMetric.ACTIVATE_TO_ACTIVATE, JobMetric.END_TO_END)
    return replace(series, period=series.period or period) if is_distance else series
