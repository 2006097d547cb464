"""Execution times that am2inc changes."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import model_rule
from amalthea_uros.validate.rules.inchron.references import missing


def is_read(value: Element) -> bool:
    """Whether a value is the default of Ticks or, if there is none, the first extended entry."""
    holder = value.container
    if isinstance(holder, am.TicksEntry):
        ticks = holder.container
        return isinstance(ticks, am.Ticks) and ticks.default is None and ticks.extended[0] is holder
    return isinstance(holder, am.Ticks)


@model_rule("INC-SW-TICKS-DEFAULT", am.Ticks)
def _check_default(element: am.Ticks, context: Context) -> Iterator[str]:
    match element.default, len(element.extended):
        case None, 0:
            yield "the Ticks have no value"
        case None, _:
            yield "the Ticks have no default value; am2inc uses the first extended one for all processing units"
        case _, count if count:
            yield "the Ticks have extended values; am2inc uses the default one for all processing units"


@model_rule("INC-SW-TICKS-STAT", am.DiscreteValueStatistics)
def _check_statistics(element: am.DiscreteValueStatistics, context: Context) -> Iterator[str]:
    if is_read(element):
        yield "the statistics are changed to a normal distribution with an estimated standard deviation by am2inc"


@model_rule("INC-SW-TICKS-BETA", am.DiscreteValueBetaDistribution)
def _check_beta(element: am.DiscreteValueBetaDistribution, context: Context) -> Iterator[str]:
    if is_read(element):
        yield "the beta distribution is changed to its upper bound by am2inc"


@model_rule("INC-SW-TICKS-BOUNDS", am.DiscreteValueBoundaries)
def _check_boundaries(element: am.DiscreteValueBoundaries, context: Context) -> Iterator[str]:
    if element.sampling_type in (None, "default") and is_read(element):
        yield "the boundaries use the default sampling type"


@model_rule("INC-SW-TICKS-GAUSS", am.DiscreteValueGaussDistribution)
def _check_gauss(element: am.DiscreteValueGaussDistribution, context: Context) -> Iterator[str]:
    absent = missing({"lower bound": element.lower_bound, "upper bound": element.upper_bound})
    if absent and is_read(element):
        yield f"the Gaussian distribution has no {absent}"


#: The parameters of distributions that can be fractions, but that am2inc reads as integers.
_PARAMETERS: dict[type[Element], tuple[str, ...]] = {
    am.DiscreteValueStatistics: ("average",),
    am.DiscreteValueGaussDistribution: ("mean", "sd"),
    am.DiscreteValueWeibullEstimatorsDistribution: ("average",),
}


@model_rule("INC-SW-TICKS-INT", am.IDiscreteValueDeviation)
def _check_fractions(element: am.IDiscreteValueDeviation, context: Context) -> Iterator[str]:
    for name in _PARAMETERS.get(type(element), ()) if is_read(element) else ():
        value: float | None = getattr(element, name)
        if value is not None and not float(value).is_integer():
            yield f"the {name.replace('sd', 'standard deviation')} of {value} ticks is truncated to an integer by am2inc"
