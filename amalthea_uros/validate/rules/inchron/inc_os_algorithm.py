"""Unsupported scheduling policy."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import TaskScheduler
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: TaskScheduler, context: Context) -> Iterator[str]:
    before = getattr(element, "scheduling_algorithm", None)
    policy = (
        element.definition.name if element.definition is not None else type(before).__name__ if before is not None else None
    )
    if policy not in (None, "FixedPriorityPreemptive"):
        yield f"the policy {policy} of the scheduler {element.name or ''!r} is changed to FixedPriorityPreemptive by am2inc"


RULE = ModelRule(
    id="INC-OS-ALGORITHM",
    title="unsupported scheduling policy",
    severity=Severity.WARNING,
    target=TaskScheduler,
    check=_check,
    rationale="am2inc silently turns every scheduler into a fixed-priority preemptive one.",
    remedy="Use FixedPriorityPreemptive, or expect different results after the import.",
    fails="""
<osModel>
  <schedulerDefinitions name="EarliestDeadlineFirst"/>
  <operatingSystems name="OS">
    <taskSchedulers name="S" definition="EarliestDeadlineFirst?type=SchedulerDefinition"/>
  </operatingSystems>
</osModel>
""",
    edits={
        'name="EarliestDeadlineFirst"': 'name="FixedPriorityPreemptive"',
        'definition="EarliestDeadlineFirst?type=SchedulerDefinition"': 'definition="FixedPriorityPreemptive?type=SchedulerDefinition"',
    },
)
