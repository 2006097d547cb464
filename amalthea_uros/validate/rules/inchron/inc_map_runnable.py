"""Runnable allocation."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import RunnableAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: RunnableAllocation, context: Context) -> Iterator[str]:
    name = element.entity.name if element.entity is not None else None
    yield f"the allocation of the runnable {name or ''!r} is dropped by am2inc"


RULE = ModelRule(
    id="INC-MAP-RUNNABLE",
    title="runnable allocation",
    severity=Severity.WARNING,
    target=RunnableAllocation,
    check=_check,
    rationale="am2inc drops runnable allocations and prints a warning.",
    remedy="Allocate the tasks that call the runnable.",
    fails="""
<swModel>
  <runnables name="R"/>
</swModel>
<mappingModel>
  <runnableAllocation entity="R?type=Runnable"/>
</mappingModel>
""",
    passes="""
<mappingModel/>
""",
)
