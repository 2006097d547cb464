"""Cooperative task."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Task
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Task, context: Context) -> Iterator[str]:
    if element.preemption == "cooperative":
        yield f"the cooperative task {element.name!r} becomes non-preemptive"


RULE = ModelRule(
    id="INC-SW-PREEMPTION",
    title="cooperative task",
    severity=Severity.WARNING,
    target=Task,
    check=_check,
    rationale="It becomes non-preemptive, without a word.",
    remedy="Expect longer blocking after the import, or make it preemptive.",
    fails="""
<swModel>
  <tasks name="T" preemption="cooperative"/>
</swModel>
""",
    passes="""
<swModel>
  <tasks name="T" preemption="preemptive"/>
</swModel>
""",
)
