"""Distributions: the same eight of discrete values (ticks, cycles), of times, and of continuous values."""

from __future__ import annotations

from amalthea_uros.bridge.codecs import PLAIN, TIME, Codec, same_names
from amalthea_uros.bridge.entries import Entry, Field, Table, part, parts
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

    def theirs(suffix: str) -> type[Element]:
        found: type[Element] = getattr(am, f"{prefix}{suffix}")
        return found

    lower, upper = Field("lower", "lower_bound", number), Field("upper", "upper_bound", number)
    average = Field("average", "average", mean)
    sampling = Field("sampling", "sampling_type", same_names(perf.Sampling, am.SamplingType))
    bucket = Table(Entry(perf.Bucket, theirs("HistogramEntry"), lower, upper, Field("occurrences", "occurrences")))
    return Table(
        Entry(perf.Constant, theirs("Constant"), Field("value", "value", number)),
        Entry(perf.Boundaries, theirs("Boundaries"), lower, upper, sampling),
        Entry(perf.Statistics, theirs("Statistics"), lower, average, upper),
        Entry(perf.Uniform, theirs("UniformDistribution"), lower, upper),
        Entry(
            perf.Gauss,
            theirs("GaussDistribution"),
            Field("mean", "mean", mean),
            Field("deviation", "sd", mean),
            lower,
            upper,
        ),
        Entry(
            perf.Weibull,
            theirs("WeibullEstimatorsDistribution"),
            lower,
            average,
            upper,
            Field("exceeding", "p_remain_promille"),
        ),
        Entry(perf.Beta, theirs("BetaDistribution"), Field("alpha", "alpha"), Field("beta", "beta"), lower, upper),
        Entry(perf.Histogram, theirs("Histogram"), Field("buckets", "entries", parts(bucket))),
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
