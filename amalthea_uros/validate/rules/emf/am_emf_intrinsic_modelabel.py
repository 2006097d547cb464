"""Initial value of a mode label."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ModeLabel
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.emf._modes import allowed_values, is_value_of


def _check(element: ModeLabel, context: Context) -> Iterator[str]:
    if element.mode is None:
        yield f"the mode label {element.name!r} has no mode"
    elif element.initial_value is not None and not is_value_of(element.mode, element.initial_value):
        yield f"{element.name!r} starts with {element.initial_value!r}, which is not {allowed_values(element.mode)}"


RULE = ModelRule(
    id="AM-EMF-INTRINSIC/ModeLabel",
    title="mode label without a mode, or with a value that it does not have",
    severity=Severity.ERROR,
    target=ModeLabel,
    check=_check,
    rationale="What depends on the mode has no meaning then. APP4MC reports it when it validates the model.",
    remedy="Give it a mode, and one of its values.",
    fails="""
<swModel>
  <modes xsi:type="am:EnumMode" name="M">
    <literals name="on"/>
    <literals name="off"/>
  </modes>
  <modeLabels name="L" mode="M?type=EnumMode" initialValue="half"/>
</swModel>
""",
    passes="""
<swModel>
  <modes xsi:type="am:EnumMode" name="M">
    <literals name="on"/>
    <literals name="off"/>
  </modes>
  <modeLabels name="L" mode="M?type=EnumMode" initialValue="on"/>
</swModel>
""",
)
