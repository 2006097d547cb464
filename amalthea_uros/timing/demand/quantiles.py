"""Unbounded distributions of execution times, cut off at quantiles that the user states.

A normal distribution without bounds has no worst case. With a probability q, its values are taken to lie between the quantiles q and
1 - q, as if these were bounds: a value is beyond each of them with the probability q at most (of n independent values of a job, any
of them with n q at most). Fewer than 0 ticks are no execution time. The quantiles are those of the standard normal distribution
(M. J. Wichura, "Algorithm AS 241", Applied Statistics 37, 1988), rounded outwards.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import ceil, floor, isfinite

from amalthea_uros.perf.activities import Activity, Execute, ExecutionNeed
from amalthea_uros.perf.distributions import Distribution, Gauss
from amalthea_uros.perf.system import System

#: More than the relative error of the quantiles.
_MARGIN = 1 + 1e-12


def quantile_assumption(probability: Fraction) -> str:
    """The assumption behind all results if distributions are cut off."""
    return (
        "values of unbounded distributions of execution times are beyond their bounds with a probability of "
        f"{float(probability):g} each, which is taken as never (--quantile)"
    )


def quantile_condition(probability: Fraction) -> str:
    """The same, short, for the verdict on a whole system."""
    return f"if no execution time is beyond its quantile of {float(probability):g} (--quantile)"


def with_quantiles(system: System, probability: Fraction) -> System:
    """The system with bounds for the execution times that have none."""
    return system.with_activities(lambda activity: _bounded_activity(activity, probability))


def _bounded_activity(activity: Activity, probability: Fraction) -> Activity:
    match activity:
        case Execute(demand=demand):
            ticks = None if demand.ticks is None else bounded(demand.ticks, probability)
            by_type = tuple((name, bounded(each, probability)) for name, each in demand.by_core_type)
            return replace(activity, demand=replace(demand, ticks=ticks, by_core_type=by_type))
        case ExecutionNeed(needs=needs):
            return replace(activity, needs=tuple((name, bounded(each, probability)) for name, each in needs))
    return activity


def bounded(distribution: Distribution[int], probability: Fraction) -> Distribution[int]:
    """A distribution of ticks with quantiles in place of the bounds that it does not have."""
    match distribution:
        case Gauss(mean=mean, deviation=deviation, lower=lower, upper=upper) if isfinite(mean) and isfinite(deviation):
            from statistics import NormalDist  # imports five other modules

            distance = -NormalDist().inv_cdf(float(probability)) * abs(deviation) * _MARGIN
            least = max(0, floor(mean - distance)) if lower is None else lower
            return replace(distribution, lower=least, upper=ceil(mean + distance) if upper is None else upper)
    return distribution
