"""Burst that cannot be counted."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import PeriodicBurstStimulus
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: PeriodicBurstStimulus, context: Context) -> Iterator[str]:
    distance = element.occurrence_min_distance
    if not element.occurrence_count and not (distance is not None and distance.value):
        yield f"the burst {element.name!r} has neither a count nor a distance"


RULE = ModelRule(
    id="INC-ST-BURST",
    title="burst that cannot be counted",
    severity=Severity.WARNING,
    target=PeriodicBurstStimulus,
    check=_check,
    rationale="am2inc divides by zero.",
    remedy="State how many occurrences a burst has, or their distance.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicBurstStimulus" name="S"/>
</stimuliModel>
""",
    passes="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicBurstStimulus" name="S" occurrenceCount="3"/>
</stimuliModel>
""",
)
