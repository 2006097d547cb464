"""Mode label without a mode."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ModeLabel
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: ModeLabel, context: Context) -> Iterator[str]:
    if element.mode is None:
        yield f"the mode label {element.name or ''!r} has no mode"


RULE = ModelRule(
    id="INC-SW-MODE-MISSING",
    title="mode label without a mode",
    severity=Severity.WARNING,
    target=ModeLabel,
    check=_check,
    rationale="am2inc ignores the mode label and prints a warning.",
    remedy="Assign a mode to the mode label.",
    fails="""
<swModel>
  <modeLabels name="L"/>
</swModel>
""",
    edits={
        '<modeLabels name="L"/>': """<modes xsi:type="am:NumericMode" name="M"/>
  <modeLabels name="L" mode="M?type=NumericMode"/>""",
    },
)
