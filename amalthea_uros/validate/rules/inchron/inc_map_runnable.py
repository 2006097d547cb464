"""Runnable allocation."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import RunnableAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: RunnableAllocation, context: Context) -> Iterator[str]:
    yield "the allocation of a runnable is dropped"


RULE = ModelRule(
    id="INC-MAP-RUNNABLE",
    title="runnable allocation",
    severity=Severity.WARNING,
    target=RunnableAllocation,
    check=_check,
    rationale="am2inc drops it, with a warning.",
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
