"""Semaphore other than a counting semaphore."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Semaphore
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Semaphore, context: Context) -> Iterator[str]:
    is_plain = element.semaphore_type in (None, "_undefined_", "CountingSemaphore")
    if not is_plain or element.priority_ceiling_protocol or element.effective("ownership"):
        yield f"the semaphore {element.name or ''!r} is changed to a plain counting semaphore by am2inc"


RULE = ModelRule(
    id="INC-OS-SEMA-TYPE",
    title="semaphore other than a counting semaphore",
    severity=Severity.WARNING,
    target=Semaphore,
    check=_check,
    rationale="am2inc silently drops the type, the priority ceiling protocol and the ownership of semaphores.",
    remedy="Use counting semaphores without priority ceiling and with ownership=false (the default since AMALTHEA 3.0.0 is true), or "
    "expect different blocking times after the import.",
    fails="""
<osModel>
  <semaphores name="S" semaphoreType="Mutex"/>
</osModel>
""",
    edits={'semaphoreType="Mutex"': 'semaphoreType="CountingSemaphore" ownership="false"'},
)
