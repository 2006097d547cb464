"""Semaphore that is more than a counter."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Semaphore
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Semaphore, context: Context) -> Iterator[str]:
    is_plain = element.semaphore_type in (None, "_undefined_", "CountingSemaphore")
    if not is_plain or element.priority_ceiling_protocol or element.ownership:
        yield f"the semaphore {element.name!r} loses its type, its priority ceiling, or its ownership"


RULE = ModelRule(
    id="INC-OS-SEMA-TYPE",
    title="semaphore that is more than a counter",
    severity=Severity.WARNING,
    target=Semaphore,
    check=_check,
    rationale="am2inc drops the type and the ceiling protocol without a word.",
    remedy="Use plain counting semaphores, or expect other blocking.",
    fails="""
<osModel>
  <semaphores name="S" semaphoreType="Mutex"/>
</osModel>
""",
    passes="""
<osModel>
  <semaphores name="S" semaphoreType="CountingSemaphore"/>
</osModel>
""",
)
