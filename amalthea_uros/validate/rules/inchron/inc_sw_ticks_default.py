"""Ticks without a default."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Ticks
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Ticks, context: Context) -> Iterator[str]:
    if element.default is None or len(element.extended) > 1:
        yield "the ticks have no default, or differ between processing units"


RULE = ModelRule(
    id="INC-SW-TICKS-DEFAULT",
    title="ticks without a default",
    severity=Severity.WARNING,
    target=Ticks,
    check=_check,
    rationale="am2inc takes the first extended entry for all processing units, or 0, without a word.",
    remedy="State default ticks.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Ticks"/>
    </activityGraph>
  </runnables>
</swModel>
""",
    passes="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueConstant" value="1"/>
      </items>
    </activityGraph>
  </runnables>
</swModel>
""",
)
