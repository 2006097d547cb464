"""Distributions: the same eight of discrete values (ticks, cycles), of times, and of continuous values."""

from __future__ import annotations

from amalthea_uros.bridge.codecs import PLAIN, TIME, Codec, same_names
from amalthea_uros.bridge.entries import Entry, Field, Table, all_parts, part
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.perf import distributions as perf


def _table(prefix: str, number: Codec, mean: Codec) -> Table:
    """The table of one kind.

    Parameters
    ----------
    number : codec of bounds
    mean : codec of averages and deviations
    """

    def amalthea_class(suffix: str) -> type[Element]:
        found: type[Element] = getattr(am, f"{prefix}{suffix}")
        return found

    lower, upper = Field("lower", "lower_bound", number), Field("upper", "upper_bound", number)
    average = Field("average", "average", mean)
    sampling = Field("sampling", "sampling_type", same_names(perf.Sampling, am.SamplingType))
    bucket = Table(Entry(perf.Bucket, amalthea_class("HistogramEntry"), lower, upper, Field("occurrences", "occurrences")))
    return Table(
        Entry(perf.Constant, amalthea_class("Constant"), Field("value", "value", number)),
        Entry(perf.Boundaries, amalthea_class("Boundaries"), lower, upper, sampling),
        Entry(perf.Statistics, amalthea_class("Statistics"), lower, average, upper),
        Entry(perf.Uniform, amalthea_class("UniformDistribution"), lower, upper),
        Entry(
            perf.Gauss,
            amalthea_class("GaussDistribution"),
            Field("mean", "mean", mean),
            Field("deviation", "sd", mean),
            lower,
            upper,
        ),
        Entry(
            perf.Weibull,
            amalthea_class("WeibullEstimatorsDistribution"),
            lower,
            average,
            upper,
            Field("exceeding", "p_remain_promille"),
        ),
        Entry(perf.Beta, amalthea_class("BetaDistribution"), Field("alpha", "alpha"), Field("beta", "beta"), lower, upper),
        Entry(perf.Histogram, amalthea_class("Histogram"), Field("buckets", "entries", all_parts(bucket))),
    )


def _float(value: float) -> float:
    return float(value)


_MEAN = Codec(lambda value, _: _float(value), lambda value, _context, _element: value)
_MEAN_TIME = Codec(lambda value, context: TIME.build(round(value), context), TIME.extract)

DISCRETE = _table("DiscreteValue", PLAIN, _MEAN)
TIME_DISTRIBUTIONS = _table("Time", TIME, _MEAN_TIME)
CONTINUOUS = _table("ContinuousValue", _MEAN, _MEAN)

#: Ticks, cycles.
TICKS = part(DISCRETE)
#: Jitter, distances.
TIME_SPAN = part(TIME_DISTRIBUTIONS)
#: Occurrences per step.
NUMBER = part(CONTINUOUS)
