"""Mode label set to a number."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ModeLabel, ModeLabelAccess, NumericMode
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: ModeLabelAccess, context: Context) -> Iterator[str]:
    match element:
        case ModeLabelAccess(data=ModeLabel(mode=NumericMode()) as label, access="set"):
            step = element.effective("step")
            yield f"the mode label {label.name or ''!r} is set to the step {step} instead of {element.value or ''!r}"


RULE = ModelRule(
    id="INC-SW-MODE-NUMSET",
    title="mode label set to a number",
    severity=Severity.WARNING,
    target=ModeLabelAccess,
    check=_check,
    rationale="am2inc silently uses the step of the access instead of its value.",
    remedy="Increment or decrement the mode label instead.",
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
    edits={'access="set" value="5"': 'access="increment" step="5"'},
)
