"""Distribution without bounds."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import IDiscreteValueDeviation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import runnable_with
from amalthea_uros.validate.quantities import bounds
from amalthea_uros.validate.rule import ModelRule


def _check(element: IDiscreteValueDeviation, context: Context) -> Iterator[str]:
    for bound, side in zip(bounds(element), ("lower", "upper"), strict=True):
        if bound is None:
            yield f"the {type(element).__name__} has no {side} bound"


RULE = ModelRule(
    id="TIM-BOUNDS",
    title="distribution without bounds",
    severity=Severity.WARNING,
    target=IDiscreteValueDeviation,
    check=_check,
    rationale="Without an upper bound there is no worst case; without a lower bound there is no best case.",
    remedy="Set the lower and the upper bound.",
    fails=runnable_with("""
<items xsi:type="am:Ticks">
  <default xsi:type="am:DiscreteValueGaussDistribution" mean="5" sd="1"/>
</items>
"""),
    edits={'sd="1"': 'sd="1" lowerBound="1" upperBound="9"'},
)
