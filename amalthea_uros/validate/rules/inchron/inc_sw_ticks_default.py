"""Ticks without exactly one value."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Ticks
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Ticks, context: Context) -> Iterator[str]:
    match element.default, len(element.extended):
        case None, 0:
            yield "the Ticks have no value"
        case None, _:
            yield "the Ticks have no default value; am2inc uses the first extended one for all processing units"
        case _, count if count:
            yield "the Ticks have extended values; am2inc uses the default one for all processing units"


RULE = ModelRule(
    id="INC-SW-TICKS-DEFAULT",
    title="ticks without exactly one value",
    severity=Severity.WARNING,
    target=Ticks,
    check=_check,
    rationale="am2inc uses one value for all processing units: silently the default, or else the first extended value. "
    "Without a value it uses 0 and prints a warning.",
    remedy="Set a default value and remove the extended ones.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Ticks"/>
    </activityGraph>
  </runnables>
</swModel>
""",
    edits={
        'xsi:type="am:Ticks"/>': """xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueConstant" value="1"/>
      </items>""",
    },
)
