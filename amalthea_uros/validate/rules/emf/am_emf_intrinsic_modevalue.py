"""Value with which a mode label is compared, or that it is given."""

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
        yield "it is not said which mode label is meant"
    elif label.mode is None and label.unresolved is None:
        yield f"the mode label {label.name!r} has no mode"
    elif element.value is None:
        yield f"there is no value for {label.name!r}"
    elif not is_value_of(label.mode, element.value):
        yield f"{element.value!r} for {label.name!r} is not {allowed_values(label.mode)}"


RULE = ModelRule(
    id="AM-EMF-INTRINSIC/ModeValue",
    title="value that the mode of a mode label does not have",
    severity=Severity.ERROR,
    target=ModeValue,
    check=_check,
    rationale="The condition never holds, or the assignment has no effect. APP4MC reports it when it validates the model.",
    remedy="State the mode label and one of the values of its mode.",
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
    passes="""
<swModel>
  <modes xsi:type="am:EnumMode" name="M">
    <literals name="on"/>
    <literals name="off"/>
  </modes>
  <modeLabels name="L" mode="M?type=EnumMode"/>
  <runnables name="R">
    <executionCondition>
      <entries xsi:type="am:ModeValueCondition" label="L?type=ModeLabel" value="off"/>
    </executionCondition>
  </runnables>
</swModel>
""",
)
