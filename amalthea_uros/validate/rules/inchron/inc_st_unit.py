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
        yield f"the {type(element).__name__} value {element.value} has no unit"


RULE = ModelRule(
    id="INC-ST-UNIT",
    title="quantity without a unit",
    severity=Severity.WARNING,
    target=(Time, Frequency, DataSize),
    check=_check,
    rationale="am2inc silently uses 0 ps for a time, 1000 MHz for a frequency and 1 KiB for a data size.",
    remedy="Set the unit, e.g. ms, MHz or KiB.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S">
    <recurrence value="1"/>
  </stimuli>
</stimuliModel>
""",
    edits={'value="1"': 'value="1" unit="ms"'},
)
