"""Subtraction of what measuring itself costs: the times of an empty object, from those of one that does something.

Of a single value only bounds of the cost are known, so the minimum and the maximum without it are intervals (`Series.net_range`). The
mean of the difference is the difference of the means. The values that remain are those minus the mean of the empty object: the
subtraction of the thesis (S. R. Bappanadu, University of Stuttgart, 2022, section 6.1).
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace

from amalthea_uros.measure.series import Series, TimeStatistics, shifted
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.units import Time

#: The quantities that contain the cost of measuring once.
WITH_COST = ("duration", JobMetric.NET_EXECUTION_TIME, JobMetric.GROSS_EXECUTION_TIME)


def names_of(series: Iterable[Series]) -> set[str]:
    """The names of what was measured, without the buses that are before them where there are several."""
    return {each.name.rpartition(":")[2] for each in series} | {each.name for each in series}


class Baselines:
    """Which times are subtracted from which.

    Attributes
    ----------
    missing : names of empty objects that were needed and not measured

    Parameters
    ----------
    names : objects, and the empty ones whose times are subtracted from theirs; "" stands for all others
    empty : the series of the empty ones
    """

    def __init__(self, names: Mapping[str, str], empty: Iterable[Series]) -> None:
        self._names = names
        self._costs = {each.name: each.statistics for each in reversed(tuple(empty)) if each.quantity in WITH_COST}
        self.missing: list[str] = []

    def net(self, series: Series) -> Series:
        """A series without the times of its empty object; of several buses, that of its own bus."""
        bus, _, own = series.name.rpartition(":")
        name = self._names.get(series.name) or self._names.get(own) or self._default(own)
        if name is None or series.quantity not in WITH_COST:
            return series
        cost = self._costs.get(f"{bus}:{name}") or self._costs.get(name)
        if cost is None:
            if name not in self.missing:
                self.missing.append(name)
            return series
        return without(series, cost)

    def _default(self, own: str) -> str | None:
        return None if own in self._names.values() else self._names.get("")


def subtracted_objects(series: Collection[Series]) -> set[str]:
    """The objects whose times were subtracted from those of other objects."""
    subtracted = [each.baseline for each in series if each.baseline is not None]
    return {each.name for each in series if each.statistics in subtracted}


def without(series: Series, baseline: TimeStatistics) -> Series:
    """A series without the mean of a baseline, rounded to a picosecond."""
    return _moved(series, -round(baseline.mean), baseline)


def with_baseline(series: Series) -> Series:
    """A series as it was measured: with what was subtracted from it."""
    return series if series.baseline is None else _moved(series, round(series.baseline.mean), None)


def _moved(series: Series, time: Time, baseline: TimeStatistics | None) -> Series:
    return replace(
        series,
        statistics=None if series.statistics is None else shifted(series.statistics, time),
        values=None if series.values is None else series.values + time,
        baseline=baseline,
    )
