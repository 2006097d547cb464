"""Stimulus without a distance between its occurrences."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import PeriodicBurstStimulus, PeriodicStimulus, PeriodicSyntheticStimulus, Stimulus
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Stimulus, context: Context) -> Iterator[str]:
    if isinstance(element, PeriodicStimulus | PeriodicSyntheticStimulus | PeriodicBurstStimulus):
        period = element.recurrence
        if period is None or not period.unit or not (period.value or 0) > 0:
            yield f"the stimulus {element.name!r} has no recurrence above zero with a unit"


RULE = ModelRule(
    id="TIM-PERIOD",
    title="stimulus without a distance between its occurrences",
    severity=Severity.WARNING,
    target=Stimulus,
    check=_check,
    rationale="Nothing bounds how often it occurs, and with it the load.",
    remedy="State a recurrence above zero, with its unit.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S"/>
</stimuliModel>
""",
    passes="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S">
    <recurrence value="1" unit="ms"/>
  </stimuli>
</stimuliModel>
""",
)
