"""Unsupported stimulus."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Process, Stimulus
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._stimuli import NOT_CONVERTED


def _check(element: Stimulus | Process, context: Context) -> Iterator[str]:
    if isinstance(element, NOT_CONVERTED):
        yield f"the {type(element).__name__} {name_of(element)!r} is not converted by am2inc"
    if isinstance(element, Process):
        for stimulus in element.stimuli:
            if isinstance(stimulus, NOT_CONVERTED):
                yield f"{element.name or ''!r} is not activated by its stimulus {stimulus.name or ''!r}, which am2inc does not convert"


RULE = ModelRule(
    id="INC-ST-TYPE",
    title="unsupported stimulus",
    severity=Severity.WARNING,
    target=(Process, *NOT_CONVERTED),
    check=_check,
    rationale="am2inc does not convert event, custom, arrival curve or variable rate stimuli. It prints a warning, and the "
    "stimuli activate nothing.",
    remedy="Use a periodic (also synthetic or burst), relative periodic, single or inter-process stimulus.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:VariableRateStimulus" name="S"/>
</stimuliModel>
<swModel>
  <tasks name="T" stimuli="S?type=VariableRateStimulus"/>
</swModel>
""",
    edits={
        'xsi:type="am:VariableRateStimulus" name="S"/>': """xsi:type="am:PeriodicStimulus" name="S">
    <recurrence value="1" unit="ms"/>
  </stimuli>""",
        'stimuli="S?type=VariableRateStimulus"': 'stimuli="S?type=PeriodicStimulus"',
    },
)
