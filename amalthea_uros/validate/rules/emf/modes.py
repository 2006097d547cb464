"""Mode labels, and the values that are accessed and compared."""

from __future__ import annotations

import re
from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    EnumMode,
    Mode,
    ModeLabel,
    ModeLabelAccess,
    ModeLabelAccessEnum,
    ModeValue,
    NumericMode,
)
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule

_INTEGER = re.compile(r"-?[0-9]+")


def is_value_of(mode: Mode | None, value: str) -> bool:
    """Whether a text is a value of a mode; True if the mode is not known."""
    if isinstance(mode, EnumMode) and mode.unresolved is None:
        return value.strip() in {literal.name for literal in mode.literals}
    if isinstance(mode, NumericMode) and mode.unresolved is None:
        return _INTEGER.fullmatch(value.strip()) is not None
    return True


def allowed_values(mode: Mode | None) -> str:
    """The values of a mode, in words."""
    if isinstance(mode, EnumMode):
        return f"one of {', '.join(repr(literal.name) for literal in mode.literals)}"
    return "an integer"


def _check_label(element: ModeLabel, context: Context) -> Iterator[str]:
    if element.mode is None:
        yield f"mode label {element.name!r} has no mode"
    elif element.initial_value is not None and not is_value_of(element.mode, element.initial_value):
        yield f"the initial value {element.initial_value!r} of {element.name!r} is not {allowed_values(element.mode)}"


def _check_access(element: ModeLabelAccess, context: Context) -> Iterator[str]:
    label = element.data
    if label is None:
        yield "the access has no mode label"
    elif label.mode is None and label.unresolved is None:
        yield f"mode label {label.name!r} has no mode"
    elif element.access == ModeLabelAccessEnum.SET and element.value is not None and not is_value_of(label.mode, element.value):
        yield f"the value {element.value!r} set in {label.name!r} is not {allowed_values(label.mode)}"


def _check_value(element: ModeValue, context: Context) -> Iterator[str]:
    label = element.label
    if label is None:
        yield "the mode value has no mode label"
    elif label.mode is None and label.unresolved is None:
        yield f"mode label {label.name!r} has no mode"
    elif element.value is None:
        yield f"mode label {label.name!r} is used without a value"
    elif not is_value_of(label.mode, element.value):
        yield f"the value {element.value!r} for {label.name!r} is not {allowed_values(label.mode)}"


RULES = (
    ModelRule(
        id="AM-EMF-INTRINSIC/ModeLabel",
        title="mode label without a mode or with an invalid initial value",
        severity=Severity.ERROR,
        target=ModeLabel,
        check=_check_label,
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
    ),
    ModelRule(
        id="AM-EMF-INTRINSIC/ModeLabelAccess",
        title="invalid mode label access",
        severity=Severity.ERROR,
        target=ModeLabelAccess,
        check=_check_access,
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
    ),
    ModelRule(
        id="AM-EMF-INTRINSIC/ModeValue",
        title="invalid mode value",
        severity=Severity.ERROR,
        target=ModeValue,
        check=_check_value,
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
    ),
)
