"""Latency constraint without a maximum or a type."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import EventChainLatencyConstraint
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: EventChainLatencyConstraint, context: Context) -> Iterator[str]:
    if element.maximum is None or element.type in (None, "_undefined_"):
        yield f"the constraint {element.name!r} lacks its maximum or its type"


RULE = ModelRule(
    id="INC-LC-MAX",
    title="latency constraint without a maximum or a type",
    severity=Severity.WARNING,
    target=EventChainLatencyConstraint,
    check=_check,
    rationale="A missing maximum becomes 0, a missing type becomes reaction, without a word.",
    remedy="State the maximum and the type.",
    fails="""
<constraintsModel>
  <timingConstraints xsi:type="am:EventChainLatencyConstraint" name="L"/>
</constraintsModel>
""",
    passes="""
<constraintsModel>
  <timingConstraints xsi:type="am:EventChainLatencyConstraint" name="L" type="Age">
    <maximum value="1" unit="ms"/>
  </timingConstraints>
</constraintsModel>
""",
)
