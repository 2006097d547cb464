"""Several interrupt controllers."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import OperatingSystem
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: OperatingSystem, context: Context) -> Iterator[str]:
    count = len(element.interrupt_controllers)
    if count > 1:
        yield f"the {count} interrupt controllers of {element.name or ''!r} are merged by am2inc"


RULE = ModelRule(
    id="INC-OS-IC",
    title="several interrupt controllers",
    severity=Severity.INFO,
    target=OperatingSystem,
    check=_check,
    rationale="am2inc merges all interrupt controllers of an operating system. The ISRs keep the cores of their own "
    "controllers.",
    remedy="Use one interrupt controller per operating system, or expect all its ISRs to be scheduled together.",
    fails="""
<osModel>
  <operatingSystems name="OS">
    <interruptControllers name="A"/>
    <interruptControllers name="B"/>
  </operatingSystems>
</osModel>
""",
    edits={'    <interruptControllers name="B"/>\n': ""},
)
