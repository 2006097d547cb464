"""Process without a stimulus."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ISR, Task
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Task | ISR, context: Context) -> Iterator[str]:
    if not element.stimuli:
        yield f"nothing activates {element.name!r}"


RULE = ModelRule(
    id="INC-ST-NONE",
    title="process without a stimulus",
    severity=Severity.WARNING,
    target=(Task, ISR),
    check=_check,
    rationale="It is never activated, without a word.",
    remedy="Give it a stimulus.",
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
