"""Fractional distribution parameter."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    DiscreteValueGaussDistribution,
    DiscreteValueStatistics,
    DiscreteValueWeibullEstimatorsDistribution,
    IDiscreteValueDeviation,
)
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._ticks import is_read

#: The parameters of distributions that can be fractions, but that am2inc reads as integers.
_PARAMETERS: dict[type[Element], tuple[str, ...]] = {
    DiscreteValueStatistics: ("average",),
    DiscreteValueGaussDistribution: ("mean", "sd"),
    DiscreteValueWeibullEstimatorsDistribution: ("average",),
}


def _check(element: IDiscreteValueDeviation, context: Context) -> Iterator[str]:
    for name in _PARAMETERS.get(type(element), ()) if is_read(element) else ():
        value: float | None = getattr(element, name)
        if value is not None and not float(value).is_integer():
            yield f"the {name.replace('sd', 'standard deviation')} of {value} ticks is truncated to an integer by am2inc"


RULE = ModelRule(
    id="INC-SW-TICKS-INT",
    title="fractional distribution parameter",
    severity=Severity.INFO,
    target=IDiscreteValueDeviation,
    check=_check,
    rationale="am2inc truncates averages, means and standard deviations to integers.",
    remedy="Use whole ticks, or expect a small deviation after the import.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueStatistics" lowerBound="1" upperBound="9" average="4.5"/>
      </items>
    </activityGraph>
  </runnables>
</swModel>
""",
    edits={'average="4.5"': 'average="4"'},
)
