"""Periodic stimulus without a period."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import FixedPeriodic, Stimulus
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._importer import amount


def _check(element: Stimulus, context: Context) -> Iterator[str]:
    if isinstance(element, FixedPeriodic) and not amount(element.recurrence) > 0:
        yield f"the stimulus {element.name or ''!r} has no positive recurrence with a unit"


RULE = ModelRule(
    id="INC-ST-PERIOD",
    title="periodic stimulus without a period",
    severity=Severity.WARNING,
    target=Stimulus,
    check=_check,
    rationale="am2inc silently uses a period of 0.",
    remedy="Set a recurrence greater than 0 with a unit, e.g. 10 ms.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S"/>
</stimuliModel>
""",
    edits={
        'name="S"/>': """name="S">
    <recurrence value="1" unit="ms"/>
  </stimuli>""",
    },
)
