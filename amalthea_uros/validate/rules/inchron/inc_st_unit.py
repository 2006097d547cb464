"""Quantity without a unit."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import DataSize, Frequency, Time
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._importer import has_unit


def _check(element: Time | Frequency | DataSize, context: Context) -> Iterator[str]:
    if not has_unit(element):
        yield f"the value {element.value} has no unit"


RULE = ModelRule(
    id="INC-ST-UNIT",
    title="quantity without a unit",
    severity=Severity.WARNING,
    target=(Time, Frequency, DataSize),
    check=_check,
    rationale="am2inc takes 0 ps, 1000 MHz or 1 KiB without a word.",
    remedy="State the unit; a value without one means nothing.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S">
    <recurrence value="1"/>
  </stimuli>
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
