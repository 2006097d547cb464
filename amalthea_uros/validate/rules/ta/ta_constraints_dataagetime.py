"""Minimum data age above the maximum."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import DataAgeTime
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.ta._bounds import reversed_times


def _check(element: DataAgeTime, context: Context) -> Iterator[str]:
    yield from reversed_times("age", element.minimum_time, element.maximum_time)


RULE = ModelRule(
    id="TA-Constraints-DataAgeTime",
    title="minimum data age above the maximum",
    severity=Severity.ERROR,
    target=DataAgeTime,
    check=_check,
    rationale="No age can satisfy the constraint, so it is always violated. APP4MC's validation also reports it.",
    remedy="Swap the two values, or correct one of them.",
    fails="""
<constraintsModel>
  <dataAgeConstraints name="D">
    <dataAge xsi:type="am:DataAgeTime">
      <minimumTime value="3" unit="ms"/>
      <maximumTime value="2" unit="ms"/>
    </dataAge>
  </dataAgeConstraints>
</constraintsModel>
""",
    edits={'value="3"': 'value="1"'},
)
