"""Access that is not taken over as it is."""

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
            yield "the label access neither reads nor writes"
        case ModeLabelAccess(data=ModeLabel(mode=EnumMode()) as label) if element.access not in ("read", "set"):
            yield f"the access to {label.name!r} neither reads nor sets a literal, and is dropped"
        case ModeLabelAccess(data=ModeLabel() as label, access=None | "_undefined_"):
            yield f"the access to {label.name!r} says not what it does, and is dropped"
        case SemaphoreAccess(semaphore=None):
            yield "the semaphore access names no semaphore"


RULE = ModelRule(
    id="INC-SW-ACCESS",
    title="access that is not taken over as it is",
    severity=Severity.WARNING,
    target=(LabelAccess, ModeLabelAccess, SemaphoreAccess),
    check=_check,
    rationale="am2inc takes a label access for a read unless it writes, and drops such accesses to modes, without a word.",
    remedy="State what is accessed and how; set modes instead of incrementing them.",
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
    passes="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:LabelAccess" data="L?type=Label" access="read"/>
    </activityGraph>
  </runnables>
  <labels name="L"/>
</swModel>
""",
)
