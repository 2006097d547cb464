"""Process with a stimulus that is not converted."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ArrivalCurveStimulus, CustomStimulus, EventStimulus, Process, VariableRateStimulus
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Process, context: Context) -> Iterator[str]:
    bad = (EventStimulus, CustomStimulus, ArrivalCurveStimulus, VariableRateStimulus)
    for stimulus in element.stimuli:
        if isinstance(stimulus, bad):
            yield f"{element.name!r} is not activated by {stimulus.name!r}"


RULE = ModelRule(
    id="INC-ST-TYPE",
    title="process with a stimulus that is not converted",
    severity=Severity.WARNING,
    target=Process,
    check=_check,
    rationale="Event, custom, arrival-curve and variable-rate stimuli are not converted; the process is not activated by them.",
    remedy="Use periodic, relative periodic, single or inter-process stimuli.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:VariableRateStimulus" name="S"/>
</stimuliModel>
<swModel>
  <tasks name="T" stimuli="S?type=VariableRateStimulus"/>
</swModel>
""",
    passes="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S">
    <recurrence value="1" unit="ms"/>
  </stimuli>
</stimuliModel>
<swModel>
  <tasks name="T" stimuli="S?type=PeriodicStimulus"/>
</swModel>
""",
)
