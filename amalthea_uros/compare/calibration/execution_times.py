"""Measured execution times as those of a description."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from math import ceil, floor
from typing import TYPE_CHECKING

from amalthea_uros._internal.records import dataclass
from amalthea_uros.compare.calibration.options import CalibrationOptions, Form
from amalthea_uros.compare.calibration.samples import Measured, Samples, samples_of, without_others
from amalthea_uros.compare.calibration.stated_overheads import stated_overhead
from amalthea_uros.compare.calibration.values import CalibratedValue, Outcome, calibrated
from amalthea_uros.compare.calibration.wire_parts import WITHOUT_WAITS, ExecutedTime, without_parts, without_waits
from amalthea_uros.compare.calibration.wording import percentage
from amalthea_uros.design.description.assign import Assignment
from amalthea_uros.design.description.built_objects import BuiltObjects
from amalthea_uros.design.description.owners import StatedTime
from amalthea_uros.design.description.text_edits import Path, Value
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.measure.series import MeasuredKind
from amalthea_uros.perf.distributions import highest, lowest
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.units import NANOSECOND, Time, time_text
from amalthea_uros.uros.assembly.demand import times_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

#: More different values than this are put into so many ranges.
_MOST_BUCKETS = 20
#: Nothing is executed in less: a cycle of a core at 1 GHz.
_LEAST = NANOSECOND
#: Significant digits of bounds with a margin.
_DIGITS = 4


#: The measured quantities that are execution times; gross ones include preemption.
QUANTITIES = (JobMetric.NET_EXECUTION_TIME, "duration", JobMetric.GROSS_EXECUTION_TIME)


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


def calibrated_execution_times(
    measured: Sequence[Measured], built: BuiltObjects, options: CalibrationOptions, executed: Mapping[str, ExecutedTime]
) -> Iterator[CalibratedValue]:
    """The measured execution times, by what of the description states them.

    Parameters
    ----------
    executed : what executors that loop execute, with what the wire takes
    """
    groups: dict[Path, tuple[StatedTime, list[Measured]]] = {}
    with_runnables = {id(each.source) for each in measured if each.series.kind is MeasuredKind.RUNNABLE}
    for each in _one_per_object(without_waits(measured, executed)):
        known = executed.get(each.series.name)
        if not built.knows(each.series.name):
            continue
        try:
            stated = built.execution_time(each.series.name)
        except InvalidArgumentError as error:
            if each.series.kind is not MeasuredKind.PROCESS or id(each.source) not in with_runnables:
                target = f"{each.series.name}.execution_time"
                yield calibrated(target, samples_of([each], options.judge_on), Outcome.NOT_WRITTEN, str(error))
            continue
        overhead = _overhead(each, built)
        if overhead is None:
            reason = "its overhead varies and is part of the measured times; subtract that of an empty job with --empty"
            yield calibrated(
                f"{each.series.name}.execution_time", samples_of([each], options.judge_on), Outcome.NOT_WRITTEN, reason
            )
            continue
        if known is not None and known.can_wait and each.note != WITHOUT_WAITS:
            reason = "it can wait for the wire, which is part of the measured times; measure its running time"
            yield calibrated(
                f"{each.series.name}.execution_time", samples_of([each], options.judge_on), Outcome.NOT_WRITTEN, reason
            )
            continue
        for place in stated:
            pure = without_others(each, overhead + (place.elsewhere if known is None else 0))
            pure = pure if known is None else without_parts(pure, known.others(stated_range(place)))
            groups.setdefault(place.path, (place, []))[1].append(pure)
    for stated_time, group in groups.values():
        yield _calibrated(stated_time, _purest(group), options)


def _overhead(measured: Measured, built: BuiltObjects) -> Time | None:
    """The stated overhead that is part of measured times: of jobs as a whole, without a baseline; None if it varies."""
    series, executor = measured.series, built.description.middleware.stated_executors[0].name
    if series.kind is MeasuredKind.RUNNABLE or series.baseline is not None:
        return 0
    process = executor if series.name == f"{executor}_Spin" else series.name
    lower, upper = stated_overhead(process, built.description) or (0, 0)
    return lower if lower == upper else None


def _one_per_object(measured: Sequence[Measured]) -> Iterator[Measured]:
    """For each object of a trace the quantity that is closest to an execution time."""
    seen = set()
    for quantity in QUANTITIES:
        for each in measured:
            series = each.series
            key = (id(each.source), series.kind, series.name)
            if series.quantity == quantity and series.statistics is not None and key not in seen:
                seen.add(key)
                yield each


def _purest(group: list[Measured]) -> list[Measured]:
    """Those of runnables if there are any: the times of processes include what the system does for them."""
    return [each for each in group if each.series.kind is MeasuredKind.RUNNABLE] or group


def _calibrated(stated: StatedTime, group: Sequence[Measured], options: CalibrationOptions) -> CalibratedValue:
    samples = samples_of(group, options.judge_on)
    target = stated.target
    try:
        written = written_time(stated, samples, options)
    except ValueError as error:
        return calibrated(target, samples, Outcome.NOT_WRITTEN, str(error), path=stated.path)
    held_out = samples.held_out
    outside = 0 if held_out is None else int(((held_out < written.lower) | (held_out > written.upper)).sum())
    if written.value is None:
        is_equal = (samples.lower, samples.upper) == (written.lower, written.upper)
        outcome = Outcome.CONFIRMED if is_equal else Outcome.KEPT
        reason = "" if is_equal else "the description allows more than was measured"
        return calibrated(target, samples, outcome, reason, path=stated.path, refuted=written.refuted, outside=outside)
    without = f"without {time_text(group[0].others)} of other parts; " if group[0].others else ""
    return calibrated(
        target,
        samples,
        Outcome.WRITTEN,
        path=stated.path,
        refuted=written.refuted,
        outside=outside,
        assignment=Assignment(target, stated.path, written.value),
        remark=f"{without}{margin_text(options)}",
    )


def stated_range(stated: StatedTime) -> tuple[Time, Time] | None:
    """The least and the greatest execution time that a description states for this part; None if it states none."""
    if stated.value is None:
        return None
    times = times_of(stated.value)
    lower, upper = lowest(times), highest(times)
    if lower is None or upper is None:
        return None
    return floor(lower), ceil(upper)


def written_time(stated: StatedTime, samples: Samples, options: CalibrationOptions) -> Written:
    """What is written for measured execution times.

    A stated range that is wider than the new one is kept, unless it is to be narrowed.

    Raises
    ------
    ValueError : a description cannot state it; the text says why.
    """
    if samples.certain_min <= 0:
        raise ValueError("measured times are not longer than what is subtracted from them: other parts, or the baseline")
    statistics, present = samples.statistics, stated_range(stated)
    refuted: tuple[str, ...] = ()
    if present is not None:
        # Time stamps are whole picoseconds, so that a difference may be wrong by one.
        beyond = {"min": samples.certain_min < present[0] - 1, "max": samples.certain_max > present[1] + 1}
        refuted = tuple(end for end, is_beyond in beyond.items() if is_beyond)
    if options.form is Form.HISTOGRAM:
        if present is not None and not refuted and not options.tighten:
            return Written(None, *present)
        if samples.values is None:
            raise ValueError("only statistics were measured, not the values that a histogram needs; use --as bounds")
        return Written(_histogram(samples.values), statistics.min, statistics.max, refuted)
    lower, upper = _with_margin(samples, options.margin)
    if present is not None and not options.tighten:
        lower, upper = min(lower, present[0]), max(upper, present[1])
    if (lower, upper) == present and (options.form is Form.BOUNDS or not refuted):
        return Written(None, lower, upper, refuted)
    mean = round(statistics.mean)
    if options.form is Form.MEAN and lower < mean < upper:
        return Written({**_bounds(lower, upper), "avg": time_text(mean)}, lower, upper, refuted)
    return Written(_bounds(lower, upper) if lower < upper else time_text(lower), lower, upper, refuted)


def margin_text(options: CalibrationOptions) -> str:
    """How what is written differs from what was measured."""
    margin = "all values" if options.form is Form.HISTOGRAM else f"margin {percentage(options.margin)}"
    return f"{margin}; the maximum is a high-water mark, not a bound"


def written_range(samples: Samples, options: CalibrationOptions) -> Value:
    """What is written for the range of values of which only statistics are known."""
    lower, upper = _with_margin(samples, options.margin if options.form is not Form.HISTOGRAM else Fraction(0))
    mean = round(samples.statistics.mean)
    if lower == upper:
        return time_text(lower)
    return _bounds(lower, upper) if options.form is Form.BOUNDS else {**_bounds(lower, upper), "avg": time_text(mean)}


def _with_margin(samples: Samples, margin: Fraction) -> tuple[Time, Time]:
    """The extremes with a margin, rounded outwards to the resolution of the trace and to a few digits."""
    if not margin:
        return max(_LEAST, samples.lower), samples.upper
    lower = floor(samples.lower * (1 - margin) / samples.step) * samples.step
    upper = ceil(samples.upper * (1 + margin) / samples.step) * samples.step
    return max(_LEAST, _with_few_digits(lower, floor)), _with_few_digits(upper, ceil)


def _with_few_digits(time: Time, round_to: Callable[[Fraction], int]) -> Time:
    scale: int = 10 ** max(0, len(str(abs(time))) - _DIGITS)
    return round_to(Fraction(time, scale)) * scale


def _bounds(lower: Time, upper: Time) -> dict[str, Value]:
    return {"min": time_text(lower), "max": time_text(upper)}


def _histogram(values: NDArray[np.int64]) -> Value:
    """The number of values in ranges from an observed value to another: one for each value, if these are few."""
    return {
        "histogram": [
            {"min": time_text(lower), "max": time_text(upper), "count": count} for lower, upper, count in _buckets(values)
        ]
    }


def _buckets(values: NDArray[np.int64]) -> list[tuple[Time, Time, int]]:
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
