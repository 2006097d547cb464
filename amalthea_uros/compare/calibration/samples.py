"""The measured values of one quantity, of one series or several."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from math import ceil, floor
from typing import TYPE_CHECKING

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.measure.series import Measurement, Series, TimeStatistics, shifted, statistics_of
from amalthea_uros.units import NANOSECOND, Time

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Measured:
    """A series that has values, and where it comes from.

    Attributes
    ----------
    others : what was subtracted because the description states it elsewhere
    note : which of the values of the trace these are, if not all
    """

    series: Series
    source: Measurement
    others: Time = 0
    note: str = ""


@dataclass(frozen=True, slots=True)
class Samples:
    """Measured values of one quantity.

    Attributes
    ----------
    values : picoseconds; None if only statistics are known
    held_out : values that are not used, but must be within what is written
    lower, upper : what all values are within; with a baseline, whatever its share of each value is
    certain_min, certain_max : what the least and the greatest value are at most and at least, whatever the share of a baseline is
    step : the resolution, to which bounds are rounded
    """

    measured: tuple[Measured, ...]
    statistics: TimeStatistics
    values: NDArray[np.int64] | None
    held_out: NDArray[np.int64] | None
    lower: Time
    upper: Time
    certain_min: Time
    certain_max: Time
    step: Time


def without_others(measured: Measured, others: Time) -> Measured:
    """The series without a part of its times that does not vary."""
    series = measured.series
    if not others or series.statistics is None:
        return measured
    values = None if series.values is None else series.values - others
    return replace(
        measured, series=replace(series, statistics=shifted(series.statistics, -others), values=values), others=others
    )


def samples_of(measured: Sequence[Measured], judge_on: Fraction) -> Samples:
    """The values of several series together, without the share on which they are judged."""
    import numpy as np

    used, held_out = [], []
    for each in measured:
        values = each.series.values
        if values is not None:
            count = len(values) - int(len(values) * judge_on)
            used.append(values[:count])
            held_out.append(values[count:])
    are_known = len(used) == len(measured)
    values = np.concatenate(used) if are_known else None
    statistics = _merged(each.series.statistics for each in measured) if values is None else statistics_of(values)
    below, above, certain_below, certain_above = _uncertainty(measured)
    return Samples(
        measured=tuple(measured),
        statistics=statistics,
        lower=statistics.min - below,
        upper=statistics.max + above,
        certain_min=statistics.min + certain_below,
        certain_max=statistics.max - certain_above,
        values=values,
        held_out=np.concatenate(held_out) if are_known and judge_on else None,
        step=max(each.source.resolution or NANOSECOND for each in measured),
    )


def _merged(parts: Iterable[TimeStatistics | None]) -> TimeStatistics:
    known = [part for part in parts if part is not None]
    count = sum(part.count for part in known)
    return TimeStatistics(
        count=count,
        min=min(part.min for part in known),
        mean=sum((part.mean * part.count for part in known), Fraction(0)) / count,
        max=max(part.max for part in known),
        variance=None,
    )


def _uncertainty(measured: Sequence[Measured]) -> tuple[Time, Time, Time, Time]:
    """By how much values can be less and more than stated, since the share of a baseline in each of them varies."""
    baselines = [each.series.baseline for each in measured if each.series.baseline is not None]
    more = max((ceil(each.mean) - each.min for each in baselines), default=0)
    less = max((each.max - floor(each.mean) for each in baselines), default=0)
    return less, more, more, less
