"""Cooperative task."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Task
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Task, context: Context) -> Iterator[str]:
    if element.preemption == "cooperative":
        yield f"the cooperative task {element.name or ''!r} is changed to non-preemptive by am2inc"


RULE = ModelRule(
    id="INC-SW-PREEMPTION",
    title="cooperative task",
    severity=Severity.WARNING,
    target=Task,
    check=_check,
    rationale="am2inc silently makes cooperative tasks non-preemptive, which can increase the blocking of other tasks.",
    remedy="Make the task preemptive, or expect longer blocking times after the import.",
    fails="""
<swModel>
  <tasks name="T" preemption="cooperative"/>
</swModel>
""",
    edits={'preemption="cooperative"': 'preemption="preemptive"'},
)
