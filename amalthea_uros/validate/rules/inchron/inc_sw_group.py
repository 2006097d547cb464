"""Group without an order."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Group
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Group, context: Context) -> Iterator[str]:
    if element.ordered is False:
        yield "the order of the group becomes fixed"


RULE = ModelRule(
    id="INC-SW-GROUP",
    title="group without an order",
    severity=Severity.WARNING,
    target=Group,
    check=_check,
    rationale="Its order becomes fixed, with a warning.",
    remedy="Order the group, or expect this order always.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Group" ordered="false"/>
    </activityGraph>
  </runnables>
</swModel>
""",
    passes="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Group" ordered="true"/>
    </activityGraph>
  </runnables>
</swModel>
""",
)
