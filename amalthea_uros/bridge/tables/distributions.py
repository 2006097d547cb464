"""Distributions: the same eight of discrete values (ticks, cycles), of times, and of continuous values."""

from __future__ import annotations

from typing import Any

from amalthea_uros.bridge.codecs import PLAIN, TIME, Codec, same_names
from amalthea_uros.bridge.context import Extracting
from amalthea_uros.bridge.entries import ClassEntry, ClassTable, Column, all_parts, part
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
        values = {name: _given(column, element, context) for name, column in bounds.columns.items()}
        return super().extract(element, context) if None in values.values() else perf.Bounds(**values)


def _given(column: Column, element: Element, context: Extracting) -> Any:
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

    lower, upper = Column("lower_bound", number), Column("upper_bound", number)
    average = mean
    sampling = Column("sampling_type", same_names(perf.Sampling, am.SamplingType))
    bucket = ClassTable(ClassEntry(perf.Bucket, amalthea_class("HistogramEntry"), lower=lower, upper=upper, occurrences=PLAIN))
    return _Distributions(
        # Before the class that it is written as, which has a parameter more.
        ClassEntry(perf.Bounds, amalthea_class("GaussDistribution"), lower=lower, upper=upper),
        ClassEntry(perf.Constant, amalthea_class("Constant"), value=number),
        ClassEntry(perf.Boundaries, amalthea_class("Boundaries"), lower=lower, upper=upper, sampling=sampling),
        ClassEntry(perf.Statistics, amalthea_class("Statistics"), lower=lower, average=average, upper=upper),
        ClassEntry(perf.Uniform, amalthea_class("UniformDistribution"), lower=lower, upper=upper),
        ClassEntry(
            perf.Gauss, amalthea_class("GaussDistribution"), mean=mean, deviation=Column("sd", mean), lower=lower, upper=upper
        ),
        ClassEntry(
            perf.Weibull,
            amalthea_class("WeibullEstimatorsDistribution"),
            lower=lower,
            average=average,
            upper=upper,
            exceeding=Column("p_remain_promille"),
        ),
        ClassEntry(perf.Beta, amalthea_class("BetaDistribution"), alpha=PLAIN, beta=PLAIN, lower=lower, upper=upper),
        ClassEntry(perf.Histogram, amalthea_class("Histogram"), buckets=Column("entries", all_parts(bucket))),
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
