"""Operating system overhead."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import OsOverhead, Scheduler, Ticks
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import SCHEDULER
from amalthea_uros.validate.rule import ModelRule


def _check(element: OsOverhead | Scheduler, context: Context) -> Iterator[str]:
    if isinstance(element, OsOverhead) and any(isinstance(part, Ticks) for part in element.walk()):
        yield f"the overhead {element.name or ''!r} contains Ticks"
    if isinstance(element, Scheduler) and element.computation_items:
        yield f"the scheduler {element.name or ''!r} has computation items"


RULE = ModelRule(
    id="INC-OS-OVERHEAD",
    title="operating system overhead",
    severity=Severity.ERROR,
    target=(OsOverhead, Scheduler),
    check=_check,
    rationale="am2inc crashes with a segmentation fault.",
    remedy="Remove Ticks from overheads and computation items from schedulers before the import.",
    fails="""
<osModel>
  <operatingSystems name="OS">
    <taskSchedulers name="S">
      <computationItems xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueConstant" value="1"/>
      </computationItems>
    </taskSchedulers>
  </operatingSystems>
</osModel>
""",
    passes=f"""
{SCHEDULER}
""",
)
