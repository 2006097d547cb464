"""Stimulus that sets modes."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Stimulus
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Stimulus, context: Context) -> Iterator[str]:
    if element.set_mode_value_list is not None:
        yield f"the modes that {element.name!r} sets are ignored"


RULE = ModelRule(
    id="INC-ST-MODELIST",
    title="stimulus that sets modes",
    severity=Severity.WARNING,
    target=Stimulus,
    check=_check,
    rationale="am2inc ignores it without a word.",
    remedy="Set the modes in the software.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S">
    <setModeValueList/>
  </stimuli>
</stimuliModel>
""",
    passes="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S"/>
</stimuliModel>
""",
)
