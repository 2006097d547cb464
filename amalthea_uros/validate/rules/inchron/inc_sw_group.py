"""Unordered group."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Group
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Group, context: Context) -> Iterator[str]:
    if element.ordered is False:
        yield "the unordered group is changed to an ordered one by am2inc"


RULE = ModelRule(
    id="INC-SW-GROUP",
    title="unordered group",
    severity=Severity.WARNING,
    target=Group,
    check=_check,
    rationale="am2inc executes the items of every group in the listed order. It prints a warning for unordered groups.",
    remedy="Make the group ordered, or expect its items to be executed always in the listed order.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Group" ordered="false"/>
    </activityGraph>
  </runnables>
</swModel>
""",
    edits={'ordered="false"': 'ordered="true"'},
)
