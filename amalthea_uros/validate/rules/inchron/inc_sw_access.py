"""Access that neither reads nor writes."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import LabelAccess
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: LabelAccess, context: Context) -> Iterator[str]:
    if element.access not in ("read", "write"):
        yield "the label access neither reads nor writes"


RULE = ModelRule(
    id="INC-SW-ACCESS",
    title="access that neither reads nor writes",
    severity=Severity.WARNING,
    target=LabelAccess,
    check=_check,
    rationale="am2inc takes it for a read without a word.",
    remedy="State whether the access reads or writes.",
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
