"""Subtraction of what measuring itself costs: the times of an empty object, from those of one that does something.

Of a single value only bounds of the cost are known, so the minimum and the maximum without it are intervals (`Series.net_range`). The
mean of the difference is the difference of the means. The values that remain are those minus the mean of the empty object: the
subtraction of the thesis (S. R. Bappanadu, University of Stuttgart, 2022, section 6.1).
"""

from __future__ import annotations

from dataclasses import replace

from amalthea_uros.measure.series import Series
from amalthea_uros.measure.statistics import Statistics, shifted
from amalthea_uros.timing.job_metric import JobMetric

#: The quantities that contain the cost of measuring once.
WITH_COST = ("duration", JobMetric.NET_EXECUTION_TIME, JobMetric.GROSS_EXECUTION_TIME)


def without(series: Series, baseline: Statistics) -> Series:
    """A series without the mean of a baseline, rounded to a picosecond."""
    mean = round(baseline.mean)
    return replace(
        series,
        statistics=None if series.statistics is None else shifted(series.statistics, -mean),
        values=None if series.values is None else series.values - mean,
        baseline=baseline,
    )
