"""Parameter that is cut to an integer."""

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

#: The parameters of distributions that need not be integers, but become ones.
_PARAMETERS: dict[type[Element], tuple[str, ...]] = {
    DiscreteValueStatistics: ("average",),
    DiscreteValueGaussDistribution: ("mean", "sd"),
    DiscreteValueWeibullEstimatorsDistribution: ("average",),
}


def _check(element: IDiscreteValueDeviation, context: Context) -> Iterator[str]:
    for name in _PARAMETERS.get(type(element), ()) if is_read(element) else ():
        value: float | None = getattr(element, name)
        if value is not None and not float(value).is_integer():
            yield f"the {name} of {value} ticks loses its fraction"


RULE = ModelRule(
    id="INC-SW-TICKS-INT",
    title="parameter that is cut to an integer",
    severity=Severity.INFO,
    target=IDiscreteValueDeviation,
    check=_check,
    rationale="am2inc cuts off the fractions of averages, means and standard deviations.",
    remedy="State whole ticks, or expect a small difference.",
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
    passes="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueStatistics" lowerBound="1" upperBound="9" average="4"/>
      </items>
    </activityGraph>
  </runnables>
</swModel>
""",
)
