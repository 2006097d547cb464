"""Segment of a chain in which nothing carries the effect."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import SystemProblem, SystemRule
from amalthea_uros.validate.system_context import SystemContext
from amalthea_uros.validate.unlinked_steps import unlinked_steps


def _check(context: SystemContext) -> Iterator[SystemProblem]:
    for step in unlinked_steps(context):
        message = f"no data flow or trigger connects {step.first!r} to {step.then!r}"
        yield SystemProblem(step.item, message, step.chain)


RULE = SystemRule(
    id="TIM-CHAIN-CARRIED",
    title="segment of an event chain without data flow or trigger",
    severity=Severity.WARNING,
    check=_check,
    rationale="Neither data, nor an activation, nor the order within a job connects the two events. The latency is computed as if one "
    "wrote a variable that the other reads, which says nothing about the real system.",
    remedy="Model the label, trigger or call that connects the events, or correct the events of the segment.",
    fails="""
<eventModel>
  <events xsi:type="am:ProcessEvent" name="start of T" eventType="start" entity="T?type=Task"/>
  <events xsi:type="am:ProcessEvent" name="end of U" eventType="terminate" entity="U?type=Task"/>
</eventModel>
<swModel>
  <tasks name="T">
    <activityGraph>
      <items xsi:type="am:LabelAccess" data="L?type=Label" access="write"/>
    </activityGraph>
  </tasks>
  <tasks name="U">
    <activityGraph>
      <items xsi:type="am:LabelAccess" data="M?type=Label" access="read"/>
    </activityGraph>
  </tasks>
  <labels name="L"/>
  <labels name="M"/>
</swModel>
<constraintsModel>
  <eventChains name="C" stimulus="start+of+T?type=ProcessEvent" response="end+of+U?type=ProcessEvent"/>
</constraintsModel>
""",
    edits={'data="M?type=Label"': 'data="L?type=Label"'},
)
