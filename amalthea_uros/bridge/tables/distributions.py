"""Distributions: the same eight of discrete values (ticks, cycles), of times, and of continuous values."""

from __future__ import annotations

from typing import Any

from amalthea_uros.bridge.basics.codecs import FLOAT, PLAIN, TIME, Codec, same_names
from amalthea_uros.bridge.basics.context import Extracting
from amalthea_uros.bridge.basics.entries import ClassEntry, ClassTable, all_parts, part
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.perf import distributions as perf


class _DistributionTable(ClassTable):
    """What misses a parameter still has its bounds, if both are stated."""

    def extract(self, element: Element, context: Extracting) -> Any:
        """The distribution; None, with a finding, if not even its bounds are stated."""
        entry = self.by_amalthea_class.get(type(element))
        found = None if entry is None else entry.complete(element, context)
        if found is None and entry is not None and entry.model_class not in (perf.Constant, perf.Histogram):
            columns = self.by_model_class[perf.Bounds].columns
            values = {
                name: codec.extract_given(getattr(element, feature), context, element)
                for name, (feature, codec) in columns.items()
            }
            found = None if None in values.values() else perf.Bounds(**values)
        return super().extract(element, context) if found is None else found


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

    lower, upper = ("lower_bound", number), ("upper_bound", number)
    sampling = ("sampling_type", same_names(perf.Sampling, am.SamplingType))
    bucket = ClassTable(ClassEntry(perf.Bucket, amalthea_class("HistogramEntry"), lower=lower, upper=upper, occurrences=PLAIN))
    return _DistributionTable(
        # Before the class that it is written as, which has a parameter more.
        ClassEntry(perf.Bounds, amalthea_class("GaussDistribution"), lower=lower, upper=upper),
        ClassEntry(perf.Constant, amalthea_class("Constant"), value=number),
        ClassEntry(perf.Boundaries, amalthea_class("Boundaries"), lower=lower, upper=upper, sampling=sampling),
        ClassEntry(perf.Statistics, amalthea_class("Statistics"), lower=lower, average=mean, upper=upper),
        ClassEntry(perf.Uniform, amalthea_class("UniformDistribution"), lower=lower, upper=upper),
        ClassEntry(
            perf.Gauss, amalthea_class("GaussDistribution"), mean=mean, deviation=("sd", mean), lower=lower, upper=upper
        ),
        ClassEntry(
            perf.Weibull,
            amalthea_class("WeibullEstimatorsDistribution"),
            lower=lower,
            average=mean,
            upper=upper,
            exceeding="p_remain_promille",
        ),
        ClassEntry(perf.Beta, amalthea_class("BetaDistribution"), alpha=PLAIN, beta=PLAIN, lower=lower, upper=upper),
        ClassEntry(perf.Histogram, amalthea_class("Histogram"), buckets=("entries", all_parts(bucket))),
    )


_MEAN_TIME = Codec(lambda value, context: TIME.build(round(value), context), TIME.extract)

DISCRETE = _table("DiscreteValue", PLAIN, FLOAT)
TIME_DISTRIBUTIONS = _table("Time", TIME, _MEAN_TIME)
CONTINUOUS = _table("ContinuousValue", FLOAT, FLOAT)

#: Ticks, cycles.
TICKS = part(DISCRETE)
#: Jitter, distances.
TIME_SPAN = part(TIME_DISTRIBUTIONS)
#: Occurrences per step.
NUMBER = part(CONTINUOUS)
