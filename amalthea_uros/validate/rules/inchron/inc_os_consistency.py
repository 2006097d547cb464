"""Operating system with data consistency."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import OperatingSystem
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: OperatingSystem, context: Context) -> Iterator[str]:
    stated = element.os_data_consistency
    if stated is not None and (stated.mode not in (None, "_undefined_", "noProtection") or next(stated.contents(), None)):
        yield f"the data consistency of the operating system {element.name or ''!r} is ignored by am2inc"


RULE = ModelRule(
    id="INC-OS-CONSISTENCY",
    title="operating system with data consistency",
    severity=Severity.WARNING,
    target=OperatingSystem,
    check=_check,
    rationale="am2inc silently ignores how an operating system keeps data consistent, so values can change between two accesses "
    "of a job.",
    remedy="Model the protection, e.g. with semaphores or copies of the labels, or do not rely on it after the import.",
    fails="""
<osModel>
  <operatingSystems name="OS">
    <osDataConsistency mode="automaticProtection"/>
  </operatingSystems>
</osModel>
""",
    edits={'mode="automaticProtection"': 'mode="noProtection"'},
)
