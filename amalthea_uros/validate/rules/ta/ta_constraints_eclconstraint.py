"""Minimum event chain latency above the maximum."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import EventChainLatencyConstraint
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.ta._bounds import reversed_times


def _check(element: EventChainLatencyConstraint, context: Context) -> Iterator[str]:
    yield from reversed_times("latency", element.minimum, element.maximum)


RULE = ModelRule(
    id="TA-Constraints-ECLConstraint",
    title="minimum event chain latency above the maximum",
    severity=Severity.ERROR,
    target=EventChainLatencyConstraint,
    check=_check,
    rationale="No latency can satisfy the constraint, so it is always violated. APP4MC's validation also reports it.",
    remedy="Swap the two values, or correct one of them.",
    fails="""
<constraintsModel>
  <timingConstraints xsi:type="am:EventChainLatencyConstraint" name="L" type="Reaction">
    <minimum value="3" unit="ms"/>
    <maximum value="2" unit="ms"/>
  </timingConstraints>
</constraintsModel>
""",
    edits={'value="3"': 'value="1"'},
)
