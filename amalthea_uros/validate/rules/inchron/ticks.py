"""Execution times that am2inc changes."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    DiscreteValueBetaDistribution,
    DiscreteValueBoundaries,
    DiscreteValueGaussDistribution,
    DiscreteValueStatistics,
    DiscreteValueWeibullEstimatorsDistribution,
    IDiscreteValueDeviation,
    Ticks,
    TicksEntry,
)
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import runnable_with
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron.missing_references import missing


def is_read(value: Element) -> bool:
    """Whether a value is the default of Ticks or, if there is none, the first extended entry."""
    holder = value.container
    if isinstance(holder, TicksEntry):
        ticks = holder.container
        return isinstance(ticks, Ticks) and ticks.default is None and ticks.extended[0] is holder
    return isinstance(holder, Ticks)


def _check_default(element: Ticks, context: Context) -> Iterator[str]:
    match element.default, len(element.extended):
        case None, 0:
            yield "the Ticks have no value"
        case None, _:
            yield "the Ticks have no default value; am2inc uses the first extended one for all processing units"
        case _, count if count:
            yield "the Ticks have extended values; am2inc uses the default one for all processing units"


def _check_statistics(element: DiscreteValueStatistics, context: Context) -> Iterator[str]:
    if is_read(element):
        yield "the statistics are changed to a normal distribution with an estimated standard deviation by am2inc"


def _check_beta(element: DiscreteValueBetaDistribution, context: Context) -> Iterator[str]:
    if is_read(element):
        yield "the beta distribution is changed to its upper bound by am2inc"


def _check_boundaries(element: DiscreteValueBoundaries, context: Context) -> Iterator[str]:
    if element.sampling_type in (None, "default") and is_read(element):
        yield "the boundaries use the default sampling type"


def _check_gauss(element: DiscreteValueGaussDistribution, context: Context) -> Iterator[str]:
    absent = missing({"lower bound": element.lower_bound, "upper bound": element.upper_bound})
    if absent and is_read(element):
        yield f"the Gaussian distribution has no {absent}"


#: The parameters of distributions that can be fractions, but that am2inc reads as integers.
_PARAMETERS: dict[type[Element], tuple[str, ...]] = {
    DiscreteValueStatistics: ("average",),
    DiscreteValueGaussDistribution: ("mean", "sd"),
    DiscreteValueWeibullEstimatorsDistribution: ("average",),
}


def _check_fractions(element: IDiscreteValueDeviation, context: Context) -> Iterator[str]:
    for name in _PARAMETERS.get(type(element), ()) if is_read(element) else ():
        value: float | None = getattr(element, name)
        if value is not None and not float(value).is_integer():
            yield f"the {name.replace('sd', 'standard deviation')} of {value} ticks is truncated to an integer by am2inc"


RULES = (
    ModelRule(
        id="INC-SW-TICKS-DEFAULT",
        title="ticks without exactly one value",
        severity=Severity.WARNING,
        target=Ticks,
        check=_check_default,
        rationale="am2inc uses one value for all processing units: silently the default, or else the first extended value. "
        "Without a value it uses 0 and prints a warning.",
        remedy="Set a default value and remove the extended ones.",
        fails=runnable_with('<items xsi:type="am:Ticks"/>'),
        edits={
            'xsi:type="am:Ticks"/>': """xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueConstant" value="1"/>
      </items>""",
        },
    ),
    ModelRule(
        id="INC-SW-TICKS-STAT",
        title="ticks described by statistics",
        severity=Severity.WARNING,
        target=DiscreteValueStatistics,
        check=_check_statistics,
        rationale="am2inc silently converts statistics to a normal distribution. As standard deviation it takes a third of the larger "
        "distance between the average and a bound, which is not specified.",
        remedy="Use another distribution, e.g. boundaries with a sampling type or a Gaussian one.",
        fails=runnable_with("""
<items xsi:type="am:Ticks">
  <default xsi:type="am:DiscreteValueStatistics" lowerBound="1" upperBound="9" average="4"/>
</items>
"""),
        edits={
            'xsi:type="am:DiscreteValueStatistics"': 'xsi:type="am:DiscreteValueBoundaries"',
            'average="4"': 'samplingType="Uniform"',
        },
    ),
    ModelRule(
        id="INC-SW-TICKS-BETA",
        title="beta distribution of ticks",
        severity=Severity.WARNING,
        target=DiscreteValueBetaDistribution,
        check=_check_beta,
        rationale="am2inc silently converts a beta distribution to its constant upper bound.",
        remedy="Use another distribution, e.g. a uniform or Gaussian one.",
        fails=runnable_with("""
<items xsi:type="am:Ticks">
  <default xsi:type="am:DiscreteValueBetaDistribution" alpha="1" beta="2" lowerBound="1" upperBound="9"/>
</items>
"""),
        edits={
            'xsi:type="am:DiscreteValueBetaDistribution"': 'xsi:type="am:DiscreteValueConstant"',
            'alpha="1" beta="2" lowerBound="1" upperBound="9"': 'value="1"',
        },
    ),
    ModelRule(
        id="INC-SW-TICKS-BOUNDS",
        title="boundaries with the default sampling type",
        severity=Severity.WARNING,
        target=DiscreteValueBoundaries,
        check=_check_boundaries,
        rationale="am2inc silently computes a wrong mean, which can be less than the lower bound.",
        remedy="Set the sampling type to BestCase, WorstCase, AverageCase, CornerCase or Uniform.",
        fails=runnable_with("""
<items xsi:type="am:Ticks">
  <default xsi:type="am:DiscreteValueBoundaries" lowerBound="1" upperBound="9"/>
</items>
"""),
        edits={'upperBound="9"': 'upperBound="9" samplingType="Uniform"'},
    ),
    ModelRule(
        id="INC-SW-TICKS-GAUSS",
        title="unbounded Gaussian distribution",
        severity=Severity.WARNING,
        target=DiscreteValueGaussDistribution,
        check=_check_gauss,
        rationale="am2inc silently truncates the distribution to 0.",
        remedy="Set both bounds.",
        fails=runnable_with("""
<items xsi:type="am:Ticks">
  <default xsi:type="am:DiscreteValueGaussDistribution" mean="5" sd="1"/>
</items>
"""),
        edits={'sd="1"': 'sd="1" lowerBound="1" upperBound="9"'},
    ),
    ModelRule(
        id="INC-SW-TICKS-INT",
        title="fractional distribution parameter",
        severity=Severity.INFO,
        target=IDiscreteValueDeviation,
        check=_check_fractions,
        rationale="am2inc truncates averages, means and standard deviations to integers.",
        remedy="Use whole ticks, or expect a small deviation after the import.",
        fails=runnable_with("""
<items xsi:type="am:Ticks">
  <default xsi:type="am:DiscreteValueStatistics" lowerBound="1" upperBound="9" average="4.5"/>
</items>
"""),
        edits={'average="4.5"': 'average="4"'},
    ),
)
