"""Initial value that the mode does not have."""

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
        yield f"{element.name!r} starts with {value!r}, which is no literal of {mode.name!r}"
    if isinstance(mode, NumericMode) and not _INTEGER.fullmatch(value.strip()):
        yield f"{element.name!r} starts with {value!r}, which is no integer"


def _literals(context: Context) -> dict[EnumMode, frozenset[str | None]]:
    return {mode: frozenset(literal.name for literal in mode.literals) for mode in context.all(EnumMode)}


RULE = ModelRule(
    id="DOC-Enum-Initial",
    title="initial value that the mode does not have",
    severity=Severity.ERROR,
    target=ModeLabel,
    check=_check,
    rationale="It is not known what branches on the mode do at first. "
    "The documentation of APP4MC asks for the name of a literal, or for an integer where the mode is numeric.",
    remedy="Start with a literal of the mode, or with an integer.",
    fails="""
<swModel>
  <modes xsi:type="am:EnumMode" name="M">
    <literals name="on"/>
  </modes>
  <modeLabels name="L" mode="M?type=EnumMode" initialValue="off"/>
</swModel>
""",
    passes="""
<swModel>
  <modes xsi:type="am:EnumMode" name="M">
    <literals name="on"/>
  </modes>
  <modeLabels name="L" mode="M?type=EnumMode" initialValue="on"/>
</swModel>
""",
)
