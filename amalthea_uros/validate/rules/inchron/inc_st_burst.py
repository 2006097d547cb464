"""Burst that cannot be counted."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import PeriodicBurstStimulus
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._importer import amount


def _check(element: PeriodicBurstStimulus, context: Context) -> Iterator[str]:
    count = 1 if element.occurrence_count is None else element.occurrence_count
    if count < 1 and not amount(element.occurrence_min_distance) > 0:
        yield f"the burst {element.name!r} has neither a count nor a distance above zero"


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
  <stimuli xsi:type="am:PeriodicBurstStimulus" name="S" occurrenceCount="0"/>
</stimuliModel>
""",
    passes="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicBurstStimulus" name="S" occurrenceCount="3"/>
</stimuliModel>
""",
)
