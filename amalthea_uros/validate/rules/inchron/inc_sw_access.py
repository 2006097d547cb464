"""Incomplete or unsupported access."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    EnumMode,
    LabelAccess,
    ModeLabel,
    ModeLabelAccess,
    SemaphoreAccess,
)
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: LabelAccess | ModeLabelAccess | SemaphoreAccess, context: Context) -> Iterator[str]:
    match element:
        case LabelAccess() if element.access not in ("read", "write"):
            yield "the label access is neither a read nor a write"
        case ModeLabelAccess(data=ModeLabel(mode=EnumMode()) as label) if element.access not in ("read", "set"):
            yield f"the access to the mode label {label.name or ''!r} neither reads nor sets a literal and is dropped by am2inc"
        case ModeLabelAccess(data=ModeLabel() as label, access=None | "_undefined_"):
            yield f"the access to the mode label {label.name or ''!r} has no access type and is dropped by am2inc"
        case SemaphoreAccess(semaphore=None):
            yield "the semaphore access has no semaphore"


RULE = ModelRule(
    id="INC-SW-ACCESS",
    title="incomplete or unsupported access",
    severity=Severity.WARNING,
    target=(LabelAccess, ModeLabelAccess, SemaphoreAccess),
    check=_check,
    rationale="am2inc silently treats every label access other than a write as a read, drops mode label accesses of an "
    "unsupported kind, and keeps semaphore accesses without a semaphore.",
    remedy="Set the accessed object and the access type; set enum modes instead of incrementing or decrementing them.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:LabelAccess" data="L?type=Label"/>
    </activityGraph>
  </runnables>
  <labels name="L"/>
</swModel>
""",
    edits={'data="L?type=Label"': 'data="L?type=Label" access="read"'},
)
