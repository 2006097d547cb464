"""Invalid initial mode value."""

from __future__ import annotations

import re
from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import EnumMode, ModeLabel, NumericMode
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule

_INTEGER = re.compile("-?[0-9]+")


def _check(element: ModeLabel, context: Context) -> Iterator[str]:
    value, mode = element.initial_value, element.mode
    if value is None or mode is None or mode.unresolved is not None:
        return
    if isinstance(mode, EnumMode) and value.strip() not in context.once(_literals).get(mode, frozenset()):
        yield f"the initial value {value!r} of {element.name!r} is not a literal of {mode.name!r}"
    if isinstance(mode, NumericMode) and not _INTEGER.fullmatch(value.strip()):
        yield f"the initial value {value!r} of {element.name!r} is not an integer"


def _literals(context: Context) -> dict[EnumMode, frozenset[str | None]]:
    return {mode: frozenset(literal.name for literal in mode.literals) for mode in context.all(EnumMode)}


RULE = ModelRule(
    id="DOC-Enum-Initial",
    title="invalid initial mode value",
    severity=Severity.ERROR,
    target=ModeLabel,
    check=_check,
    rationale="The initial result of conditions on the mode is undefined. The APP4MC documentation requires a literal of the "
    "mode, or an integer if the mode is numeric.",
    remedy="Set the initial value to a literal of the mode, or to an integer if the mode is numeric.",
    fails="""
<swModel>
  <modes xsi:type="am:EnumMode" name="M">
    <literals name="on"/>
  </modes>
  <modeLabels name="L" mode="M?type=EnumMode" initialValue="off"/>
</swModel>
""",
    edits={'initialValue="off"': 'initialValue="on"'},
)
