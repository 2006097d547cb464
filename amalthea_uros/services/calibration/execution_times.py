"""Measured execution times as those of a description."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import ceil, floor
from typing import TYPE_CHECKING

from amalthea_uros.perf.distributions import highest, lowest
from amalthea_uros.services.calibration.options import CalibrationOptions, Form
from amalthea_uros.services.calibration.samples import Samples
from amalthea_uros.services.description_edits.stated_times import StatedTime
from amalthea_uros.services.description_edits.yaml_values import Value
from amalthea_uros.units import Time
from amalthea_uros.uros.demand import times_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

#: More different values than this are put into so many ranges.
_MOST_BUCKETS = 20


@dataclass(frozen=True, slots=True)
class Written:
    """What is written for measured values.

    Attributes
    ----------
    value : None if the description stays as it is
    lower, upper : the least and the greatest time that the description allows then
    refuted : the stated ends that a measured value is beyond, "min" and "max"
    """

    value: Value | None
    lower: Time
    upper: Time
    refuted: tuple[str, ...] = ()


def stated_range(stated: StatedTime) -> tuple[Time, Time] | None:
    """The least and the greatest execution time that a description states, publishing included; None if it states none."""
    if stated.value is None:
        return None
    times = times_of(stated.value)
    lower, upper = lowest(times), highest(times)
    if lower is None or upper is None:
        return None
    return floor(lower) + stated.publishing, ceil(upper) + stated.publishing


def written_time(stated: StatedTime, samples: Samples, options: CalibrationOptions) -> Written:
    """What is written for measured execution times.

    A stated range that is wider than the new one is kept, unless it is to be narrowed.

    Raises
    ------
    ValueError : a description cannot state it; the text says why.
    """
    statistics, present = samples.statistics, stated_range(stated)
    refuted: tuple[str, ...] = ()
    if present is not None:
        beyond = {"min": statistics.min < present[0], "max": statistics.max > present[1]}
        refuted = tuple(end for end, is_beyond in beyond.items() if is_beyond)
    if options.form is Form.HISTOGRAM:
        lower, upper = statistics.min, statistics.max
    else:
        lower, upper = _with_margin(samples, options.margin)
    if present is not None and not options.tighten:
        if present[0] <= lower and upper <= present[1]:
            return Written(None, *present)
        if options.form is Form.HISTOGRAM and not refuted:
            return Written(None, *present)
        if options.form is not Form.HISTOGRAM:
            lower, upper = min(lower, present[0]), max(upper, present[1])
    if options.form is Form.HISTOGRAM:
        if samples.values is None:
            raise ValueError("only statistics were measured, not the values that a histogram needs; use --as bounds")
        return Written(stated.histogram(_buckets(samples.values)), lower, upper, refuted)
    if (lower, upper) == present and options.form is Form.BOUNDS:
        return Written(None, lower, upper, refuted)
    if options.form is Form.MEAN:
        return Written(stated.with_mean(lower, round(statistics.mean), upper), lower, upper, refuted)
    return Written(stated.bounds(lower, upper), lower, upper, refuted)


def _with_margin(samples: Samples, margin: Fraction) -> tuple[Time, Time]:
    """The extremes with a margin, rounded outwards to the resolution of the trace."""
    step, statistics = samples.step, samples.statistics
    if not margin:
        return max(1, statistics.min), statistics.max
    lower = floor(statistics.min * (1 - margin) / step) * step
    upper = ceil(statistics.max * (1 + margin) / step) * step
    return max(1, lower), upper


def _buckets(values: NDArray[np.int64]) -> list[tuple[Time, Time, int]]:
    """The number of values in ranges from an observed value to another: one for each value, if these are few."""
    import numpy as np

    found, counts = np.unique(values, return_counts=True)
    if len(found) <= _MOST_BUCKETS:
        return [(int(value), int(value), int(count)) for value, count in zip(found, counts, strict=True)]
    width = -(-(int(found[-1]) - int(found[0]) + 1) // _MOST_BUCKETS)
    places = (found - found[0]) // width
    return [
        (int(found[places == place][0]), int(found[places == place][-1]), int(counts[places == place].sum()))
        for place in np.unique(places)
    ]
