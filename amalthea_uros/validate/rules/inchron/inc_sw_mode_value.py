"""Invalid mode value."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import EnumMode, ModeLabel, ModeLabelAccess, ModeValueCondition
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._modes import fault


def _check(element: ModeLabel | ModeValueCondition | ModeLabelAccess, context: Context) -> Iterator[str]:
    match element:
        case ModeLabel() if element.mode is not None and element.initial_value:
            yield from _faults(element, element.initial_value, "starts with")
        case ModeValueCondition() if element.label is not None and element.label.unresolved is None:
            yield from _faults(element.label, element.value, "is compared with")
        case ModeLabelAccess(data=ModeLabel(mode=EnumMode()) as label, access="set"):
            yield from _faults(label, element.value, "is set to")


def _faults(label: ModeLabel, value: str | None, use: str) -> Iterator[str]:
    found = fault(value, label.mode)
    if found is not None:
        yield f"the mode label {label.name or ''!r} {use} {found}"


RULE = ModelRule(
    id="INC-SW-MODE-VALUE",
    title="invalid mode value",
    severity=Severity.WARNING,
    target=(ModeLabel, ModeValueCondition, ModeLabelAccess),
    check=_check,
    rationale="am2inc gives a mode label no initial mode or 0, gives a condition no value or 0, and drops an access. It "
    "prints a warning only for numeric modes.",
    remedy="Use a literal of the mode, or a 32-bit integer if the mode is numeric.",
    fails="""
<swModel>
  <modes xsi:type="am:EnumMode" name="M">
    <literals name="on"/>
    <literals name="off"/>
  </modes>
  <modeLabels name="L" mode="M?type=EnumMode" initialValue="up"/>
</swModel>
""",
    edits={'initialValue="up"': 'initialValue="on"'},
)
