"""Mode label without a mode or with an invalid initial value."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ModeLabel
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.emf._modes import allowed_values, is_value_of


def _check(element: ModeLabel, context: Context) -> Iterator[str]:
    if element.mode is None:
        yield f"mode label {element.name!r} has no mode"
    elif element.initial_value is not None and not is_value_of(element.mode, element.initial_value):
        yield f"the initial value {element.initial_value!r} of {element.name!r} is not {allowed_values(element.mode)}"


RULE = ModelRule(
    id="AM-EMF-INTRINSIC/ModeLabel",
    title="mode label without a mode or with an invalid initial value",
    severity=Severity.ERROR,
    target=ModeLabel,
    check=_check,
    rationale="Conditions on the mode label cannot be evaluated. APP4MC's validation also reports it.",
    remedy="Set a mode, and use one of its values as the initial value.",
    fails="""
<swModel>
  <modes xsi:type="am:EnumMode" name="M">
    <literals name="on"/>
    <literals name="off"/>
  </modes>
  <modeLabels name="L" mode="M?type=EnumMode" initialValue="half"/>
</swModel>
""",
    edits={'initialValue="half"': 'initialValue="on"'},
)
