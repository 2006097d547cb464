"""How times and ticks vary."""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite
from typing import Any

from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.exporting import Exporting
from amalthea_uros.inchron_bridge.basics.values import ticks
from amalthea_uros.perf import distributions as perf

#: Where between two boundaries values lie: the types have nearly the same names. `Mean` has a mean, which is their middle.
SAMPLINGS = {
    perf.Sampling.DEFAULT: "Mean",
    perf.Sampling.BEST_CASE: "BestCase",
    perf.Sampling.WORST_CASE: "WorstCase",
    perf.Sampling.AVERAGE_CASE: "AverageCase",
    perf.Sampling.CORNER_CASE: "CornerCase",
    perf.Sampling.UNIFORM: "Uniform",
}
_SAMPLING_OF = {name: sampling for sampling, name in SAMPLINGS.items()}


def build_demand(demand: perf.Distribution[int], context: Exporting, source: Any) -> ProjectObject:
    """A demand in ticks."""
    made: dict[str, Any] = {}
    match demand:
        case perf.Constant(value=only):
            made = {"type": "Min", "min": ticks(only), "max": ticks(only)}
        case perf.Boundaries(lower=lower, upper=upper, sampling=sampling):
            made = {"type": SAMPLINGS[sampling], "min": ticks(lower), "max": ticks(upper)}
            if sampling is perf.Sampling.DEFAULT:
                made["mean"] = ticks((lower + upper) // 2)
        case perf.Bounds(lower=lower, upper=upper):
            made = {"type": "Mean", "min": ticks(lower), "max": ticks(upper), "mean": ticks((lower + upper) // 2)}
            context.changed(source, "a distribution of which a parameter is missing", "as its bounds")
        case perf.Uniform(lower=lower, upper=upper):
            made = {"type": "Uniform", "min": ticks(lower), "max": ticks(upper)}
        case perf.Statistics(lower=lower, average=average, upper=upper):
            mean = whole_part(average)
            sigma = max(mean - lower, upper - mean) / 3
            made = {"type": "Normal", "mean": ticks(mean), "sigma": ticks(whole_part(sigma))}
            made |= {"min": ticks(lower), "max": ticks(upper)}
            context.changed(
                source, "a demand with lower bound, average and upper bound", "as a normal distribution within the bounds"
            )
        case perf.Gauss(mean=mean, deviation=deviation, lower=lower, upper=upper):
            made = {"type": "Normal", "mean": ticks(whole_part(mean)), "sigma": ticks(whole_part(deviation))}
            made |= {"min": ticks(lower or 0), "max": ticks(upper or 0)}
        case perf.Weibull(lower=lower, average=average, upper=upper, exceeding=exceeding):
            made = {"type": "WeibullEstimator", "min": ticks(lower), "max": ticks(upper), "mean": ticks(whole_part(average))}
            # The importer of INCHRON assumes 1 per mille where none is given (am2inc, activityGraph.cpp).
            made["outlierProbability"] = (exceeding if exceeding > 0 else 1.0) / 1000
        case perf.Beta(alpha=alpha, beta=beta, lower=lower, upper=upper):
            made = {"type": "Beta", "alpha": float(alpha), "beta": float(beta), "min": ticks(lower), "max": ticks(upper)}
        case perf.Histogram(buckets=buckets):
            entries = [
                ProjectObject(
                    "DiscreteDistributionEntry", count=each.occurrences, lower=ticks(each.lower), upper=ticks(each.upper)
                )
                for each in buckets
            ]
            made = {"type": "Discrete", "discreteDistribution": entries}
    return ProjectObject("TimeDistribution", **made)


def whole_part(number: float) -> int:
    """A number of a project, which is whole: without its fraction, as the importer of INCHRON writes it."""
    return int(number) if isfinite(number) else 0


def extract(item: ProjectObject, number: Callable[[ProjectObject], int | None]) -> perf.Distribution[int] | None:
    """The distribution; None if a value that it needs is not stated in a unit that can be converted.

    Parameters
    ----------
    number : converts its times, to ticks of a core or to picoseconds; None for those that it cannot
    """
    if item["type"] == "Discrete":
        return _histogram(item, number)
    lower, upper, mean, sigma = (number(item[name]) for name in ("min", "max", "mean", "sigma"))
    if lower is None or upper is None:
        return None
    match item["type"]:
        case "Normal" if mean is not None and sigma is not None:
            # The importer writes 0 for both bounds of a distribution without.
            bounds = (None, None) if (lower, upper) == (0, 0) else (lower, upper)
            return perf.Gauss(mean=float(mean), deviation=float(sigma), lower=bounds[0], upper=bounds[1])
        case "WeibullEstimator" if mean is not None:
            return perf.Weibull(lower=lower, average=float(mean), upper=upper, exceeding=item["outlierProbability"] * 1000)
        case "Beta":
            return perf.Beta(alpha=item["alpha"], beta=item["beta"], lower=lower, upper=upper)
        case "Min" | "Max" if lower >= upper:
            return perf.Constant(lower if item["type"] == "Min" else max(lower, upper))
        case "Min" | "Max" as extreme:
            sampling = perf.Sampling.BEST_CASE if extreme == "Min" else perf.Sampling.WORST_CASE
            return perf.Boundaries(lower=lower, upper=upper, sampling=sampling)
        case name if name in _SAMPLING_OF:
            return perf.Boundaries(lower=lower, upper=upper, sampling=_SAMPLING_OF[name])
    return None


def _histogram(item: ProjectObject, number: Callable[[ProjectObject], int | None]) -> perf.Histogram[int] | None:
    result = []
    for entry in item["discreteDistribution"]:
        lower, upper = number(entry["lower"]), number(entry["upper"])
        if lower is None or upper is None:
            return None
        result.append(perf.Bucket(lower=lower, upper=upper, occurrences=entry["count"]))
    return perf.Histogram(tuple(result)) if result else None
