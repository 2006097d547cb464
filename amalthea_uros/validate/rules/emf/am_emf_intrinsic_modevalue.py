"""Invalid mode value."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ModeValue
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.emf._modes import allowed_values, is_value_of


def _check(element: ModeValue, context: Context) -> Iterator[str]:
    label = element.label
    if label is None:
        yield "the mode value has no mode label"
    elif label.mode is None and label.unresolved is None:
        yield f"mode label {label.name!r} has no mode"
    elif element.value is None:
        yield f"mode label {label.name!r} is used without a value"
    elif not is_value_of(label.mode, element.value):
        yield f"the value {element.value!r} for {label.name!r} is not {allowed_values(label.mode)}"


RULE = ModelRule(
    id="AM-EMF-INTRINSIC/ModeValue",
    title="invalid mode value",
    severity=Severity.ERROR,
    target=ModeValue,
    check=_check,
    rationale="The condition is never true, or the assignment has no effect. APP4MC's validation also reports it.",
    remedy="Refer to a mode label that has a mode, and use one of the values of this mode.",
    fails="""
<swModel>
  <modes xsi:type="am:EnumMode" name="M">
    <literals name="on"/>
    <literals name="off"/>
  </modes>
  <modeLabels name="L" mode="M?type=EnumMode"/>
  <runnables name="R">
    <executionCondition>
      <entries xsi:type="am:ModeValueCondition" label="L?type=ModeLabel" value="half"/>
    </executionCondition>
  </runnables>
</swModel>
""",
    edits={'value="half"': 'value="off"'},
)
