"""Ticks that depend on the core, or have no value."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Ticks
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Ticks, context: Context) -> Iterator[str]:
    match element.default, len(element.extended):
        case None, 0:
            yield "the ticks have no value"
        case None, count:
            yield f"the first of {count} extended values is used for all processing units"
        case _, count if count:
            yield f"of a default and {count} extended values only the default is used"


RULE = ModelRule(
    id="INC-SW-TICKS-DEFAULT",
    title="ticks that depend on the core, or have no value",
    severity=Severity.WARNING,
    target=Ticks,
    check=_check,
    rationale="am2inc takes the default, else the first extended value, else 0, for all processing units and without a word.",
    remedy="State default ticks and nothing else.",
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
