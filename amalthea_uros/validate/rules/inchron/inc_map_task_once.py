"""Process without exactly one allocation."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ISR, ISRAllocation, Task, TaskAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import SCHEDULER
from amalthea_uros.validate.rule import ModelRule


def _check(element: Task | ISR, context: Context) -> Iterator[str]:
    times = context.uses(TaskAllocation, "task")[element] + context.uses(ISRAllocation, "isr")[element]
    if times != 1:
        yield f"{element.name or ''!r} is allocated {times} times" if times else f"{element.name or ''!r} is not allocated"


RULE = ModelRule(
    id="INC-MAP-TASK-ONCE",
    title="process without exactly one allocation",
    severity=Severity.WARNING,
    target=(Task, ISR),
    check=_check,
    rationale="A process without an allocation silently gets no core or disappears. A process with several allocations is "
    "silently listed several times.",
    remedy="Allocate every task and every ISR exactly once.",
    fails=f"""
{SCHEDULER}
<swModel>
  <tasks name="T"/>
</swModel>
""",
    edits={
        "</swModel>": """</swModel>
<mappingModel>
  <taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler"/>
</mappingModel>""",
    },
)
