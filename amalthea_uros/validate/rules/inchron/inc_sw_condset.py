"""Branch or loop without a condition."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ModeSwitchEntry, SwitchEntry, WhileLoop
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: WhileLoop | SwitchEntry | ModeSwitchEntry, context: Context) -> Iterator[str]:
    if not (element.condition and element.condition.entries):
        yield (
            "the while loop has no condition"
            if isinstance(element, WhileLoop)
            else f"the switch entry {element.name or ''!r} has no condition"
        )


RULE = ModelRule(
    id="INC-SW-CONDSET",
    title="branch or loop without a condition",
    severity=Severity.WARNING,
    target=(WhileLoop, SwitchEntry, ModeSwitchEntry),
    check=_check,
    rationale="am2inc writes an empty condition and prints a warning about an object without a container.",
    remedy="Set the condition; use the default entry for all remaining cases.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Switch">
        <entries name="e"/>
      </items>
    </activityGraph>
  </runnables>
</swModel>
""",
    edits={
        'name="e"/>': """name="e">
          <condition>
            <entries xsi:type="am:ModeValueCondition" relation="EQUAL" value="1"/>
          </condition>
        </entries>""",
    },
)
