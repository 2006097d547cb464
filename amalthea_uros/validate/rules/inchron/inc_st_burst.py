"""Burst without a count or distance."""

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
        yield f"the burst stimulus {element.name or ''!r} has neither a positive occurrence count nor a positive minimum distance"


RULE = ModelRule(
    id="INC-ST-BURST",
    title="burst without a count or distance",
    severity=Severity.WARNING,
    target=PeriodicBurstStimulus,
    check=_check,
    rationale="am2inc divides by zero and writes a meaningless number of activations.",
    remedy="Set the occurrence count or the minimum distance of occurrences to a value greater than 0.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicBurstStimulus" name="S" occurrenceCount="0"/>
</stimuliModel>
""",
    edits={'occurrenceCount="0"': 'occurrenceCount="3"'},
)
