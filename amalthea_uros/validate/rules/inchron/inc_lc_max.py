"""Latency constraint without a maximum or type."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import EventChainLatencyConstraint
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._missing import missing


def _check(element: EventChainLatencyConstraint, context: Context) -> Iterator[str]:
    absent = missing({"maximum": element.maximum, "type": None if element.type == "_undefined_" else element.type})
    if absent:
        yield f"the latency constraint {element.name or ''!r} has no {absent}"


RULE = ModelRule(
    id="INC-LC-MAX",
    title="latency constraint without a maximum or type",
    severity=Severity.WARNING,
    target=EventChainLatencyConstraint,
    check=_check,
    rationale="am2inc silently uses 0 for a missing maximum and Reaction for a missing type.",
    remedy="Set the maximum and the type (Age or Reaction).",
    fails="""
<constraintsModel>
  <timingConstraints xsi:type="am:EventChainLatencyConstraint" name="L"/>
</constraintsModel>
""",
    edits={
        'name="L"/>': """name="L" type="Age">
    <maximum value="1" unit="ms"/>
  </timingConstraints>""",
    },
)
