"""Distributions: the same eight of discrete values (ticks, cycles), of times, and of continuous values."""

from __future__ import annotations

from typing import Any

from amalthea_uros.bridge.codecs import PLAIN, TIME, Codec, same_names
from amalthea_uros.bridge.context import Extracting
from amalthea_uros.bridge.entries import ClassEntry, ClassTable, Field, all_parts, part
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.perf import distributions as perf


class _Distributions(ClassTable):
    """What misses a parameter still has its bounds, if both are stated."""

    def extract(self, element: Element, context: Extracting) -> Any:
        """The distribution; None, with a finding, if not even its bounds are stated."""
        entry = self.by_amalthea_class.get(type(element))
        found = None if entry is None else entry.complete(element, context)
        if found is not None or entry is None or entry.model_class in (perf.Constant, perf.Histogram):
            return found if found is not None else super().extract(element, context)
        bounds = self.by_model_class[perf.Bounds]
        values = {column.name: _given(column, element, context) for column in bounds.columns}
        return super().extract(element, context) if None in values.values() else perf.Bounds(**values)


def _given(column: Field, element: Element, context: Extracting) -> Any:
    value = getattr(element, column.feature)
    return None if value is None else column.codec.extract(value, context, element)


def _table(prefix: str, number: Codec, mean: Codec) -> ClassTable:
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
    bucket = ClassTable(
        ClassEntry(perf.Bucket, amalthea_class("HistogramEntry"), lower, upper, Field("occurrences", "occurrences"))
    )
    return _Distributions(
        # Before the class that it is written as, which has a parameter more.
        ClassEntry(perf.Bounds, amalthea_class("GaussDistribution"), lower, upper),
        ClassEntry(perf.Constant, amalthea_class("Constant"), Field("value", "value", number)),
        ClassEntry(perf.Boundaries, amalthea_class("Boundaries"), lower, upper, sampling),
        ClassEntry(perf.Statistics, amalthea_class("Statistics"), lower, average, upper),
        ClassEntry(perf.Uniform, amalthea_class("UniformDistribution"), lower, upper),
        ClassEntry(
            perf.Gauss,
            amalthea_class("GaussDistribution"),
            Field("mean", "mean", mean),
            Field("deviation", "sd", mean),
            lower,
            upper,
        ),
        ClassEntry(
            perf.Weibull,
            amalthea_class("WeibullEstimatorsDistribution"),
            lower,
            average,
            upper,
            Field("exceeding", "p_remain_promille"),
        ),
        ClassEntry(perf.Beta, amalthea_class("BetaDistribution"), Field("alpha", "alpha"), Field("beta", "beta"), lower, upper),
        ClassEntry(perf.Histogram, amalthea_class("Histogram"), Field("buckets", "entries", all_parts(bucket))),
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
