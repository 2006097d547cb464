"""Minimum delay above the maximum."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import DelayConstraint
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.ta._bounds import reversed_times


def _check(element: DelayConstraint, context: Context) -> Iterator[str]:
    yield from reversed_times("delay", element.lower, element.upper)


RULE = ModelRule(
    id="TA-Constraints-DelayConstraint",
    title="minimum delay above the maximum",
    severity=Severity.ERROR,
    target=DelayConstraint,
    check=_check,
    rationale="No delay can satisfy the constraint, so it is always violated. APP4MC's validation also reports it.",
    remedy="Swap the two values, or correct one of them.",
    fails="""
<constraintsModel>
  <timingConstraints xsi:type="am:DelayConstraint" name="D">
    <upper value="2" unit="ms"/>
    <lower value="3" unit="ms"/>
  </timingConstraints>
</constraintsModel>
""",
    edits={'value="3"': 'value="1"'},
)
