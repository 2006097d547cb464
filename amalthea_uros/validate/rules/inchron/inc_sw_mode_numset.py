"""Number that a mode label is set to."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ModeLabel, ModeLabelAccess, NumericMode
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: ModeLabelAccess, context: Context) -> Iterator[str]:
    match element:
        case ModeLabelAccess(data=ModeLabel(mode=NumericMode()) as label, access="set"):
            yield f"{label.name!r} is set to the step, {element.effective('step')}, instead of {element.value or ''!r}"


RULE = ModelRule(
    id="INC-SW-MODE-NUMSET",
    title="number that a mode label is set to",
    severity=Severity.WARNING,
    target=ModeLabelAccess,
    check=_check,
    rationale="am2inc takes the step for the value without a word.",
    remedy="Increment or decrement the label instead.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:ModeLabelAccess" data="L?type=ModeLabel" access="set" value="5"/>
    </activityGraph>
  </runnables>
  <modes xsi:type="am:NumericMode" name="M"/>
  <modeLabels name="L" mode="M?type=NumericMode"/>
</swModel>
""",
    passes="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:ModeLabelAccess" data="L?type=ModeLabel" access="increment" step="5"/>
    </activityGraph>
  </runnables>
  <modes xsi:type="am:NumericMode" name="M"/>
  <modeLabels name="L" mode="M?type=NumericMode"/>
</swModel>
""",
)
