"""Execution demand: ticks on any core, where a system can have ticks for each type of core."""

from __future__ import annotations

from amalthea_uros.inchron_bridge.basics.exporting import Exporting
from amalthea_uros.perf.activities import Demand
from amalthea_uros.perf.distributions import Boundaries, Constant, Distribution, Gauss, Sampling, highest, lowest


def of_every_core_type(demand: Demand, context: Exporting) -> tuple[Distribution[int], bool]:
    """The demand on any core, and whether a project says the same.

    Where types of cores differ, it is between the least and the most on one of them.
    """
    types = {core.type for core in context.system.cores.values()}
    given = [ticks for name, ticks in demand.by_core_type if name in types]
    if demand.ticks is not None and not types <= {name for name, _ in demand.by_core_type}:
        given.insert(0, demand.ticks)
    given = given or [ticks for _, ticks in demand.by_core_type] or [Constant(0)]
    if all(ticks == given[0] for ticks in given):
        return given[0], demand == Demand(given[0]) and not is_approximated(given[0])
    context.changed(None, "a demand that depends on the type of core", "as the range of all types")
    bounds = [(lowest(ticks), highest(ticks)) for ticks in given]
    lower, upper = min(low or 0 for low, _ in bounds), max((high or 0 for _, high in bounds), default=0)
    return Boundaries(lower=lower, upper=upper, sampling=Sampling.WORST_CASE), False


def is_approximated(ticks: Distribution[int]) -> bool:
    """Whether a project has no distribution of this kind, has another kind for it, too, or only whole numbers for its parameters."""
    match ticks:
        case Gauss(mean=mean, deviation=deviation, lower=lower, upper=upper):
            unbounded = lower is None and upper is None
            return not (
                float(mean).is_integer() and float(deviation).is_integer() and (unbounded or None not in (lower, upper))
            )
        case Constant() | Boundaries():
            return False
    return type(ticks).__name__ in ("Statistics", "Bounds", "Uniform", "Weibull")
