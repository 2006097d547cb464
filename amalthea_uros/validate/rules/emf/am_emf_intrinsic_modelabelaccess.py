"""Invalid mode label access."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ModeLabelAccess, ModeLabelAccessEnum
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.emf._modes import allowed_values, is_value_of


def _check(element: ModeLabelAccess, context: Context) -> Iterator[str]:
    label = element.data
    if label is None:
        yield "the access has no mode label"
    elif label.mode is None and label.unresolved is None:
        yield f"mode label {label.name!r} has no mode"
    elif element.access == ModeLabelAccessEnum.SET and element.value is not None and not is_value_of(label.mode, element.value):
        yield f"the value {element.value!r} set in {label.name!r} is not {allowed_values(label.mode)}"


RULE = ModelRule(
    id="AM-EMF-INTRINSIC/ModeLabelAccess",
    title="invalid mode label access",
    severity=Severity.ERROR,
    target=ModeLabelAccess,
    check=_check,
    rationale="The access leaves the mode label without a valid value. APP4MC's validation also reports it.",
    remedy="Refer to a mode label that has a mode, and set one of the values of this mode.",
    fails="""
<swModel>
  <modes xsi:type="am:EnumMode" name="M">
    <literals name="on"/>
    <literals name="off"/>
  </modes>
  <modeLabels name="L" mode="M?type=EnumMode"/>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:ModeLabelAccess" data="L?type=ModeLabel" access="set" value="half"/>
    </activityGraph>
  </runnables>
</swModel>
""",
    edits={'value="half"': 'value="off"'},
)
