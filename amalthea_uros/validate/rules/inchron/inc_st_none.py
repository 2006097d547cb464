"""Process without a stimulus."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ISR, Task
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Task | ISR, context: Context) -> Iterator[str]:
    if not element.stimuli:
        yield f"{element.name or ''!r} has no stimulus"


RULE = ModelRule(
    id="INC-ST-NONE",
    title="process without a stimulus",
    severity=Severity.WARNING,
    target=(Task, ISR),
    check=_check,
    rationale="am2inc converts the process without a warning, but it is never activated.",
    remedy="Assign a stimulus to the process.",
    fails="""
<swModel>
  <tasks name="T"/>
</swModel>
""",
    passes="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S"/>
</stimuliModel>
<swModel>
  <tasks name="T" stimuli="S?type=PeriodicStimulus"/>
</swModel>
""",
)
