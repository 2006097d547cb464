"""Stimuli that am2inc does not convert."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import dropwhile

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    ArrivalCurveStimulus,
    CustomStimulus,
    EventStimulus,
    Process,
    Stimulus,
    VariableRateStimulus,
)
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule

#: The classes of stimuli that am2inc does not convert.
NOT_CONVERTED = (EventStimulus, CustomStimulus, ArrivalCurveStimulus, VariableRateStimulus)


def _check_type(element: Stimulus | Process, context: Context) -> Iterator[str]:
    if isinstance(element, NOT_CONVERTED):
        yield f"the {type(element).__name__} {name_of(element)!r} is not converted by am2inc"
    if isinstance(element, Process):
        for stimulus in element.stimuli:
            if isinstance(stimulus, NOT_CONVERTED):
                yield f"{element.name or ''!r} is not activated by its stimulus {stimulus.name or ''!r}, which am2inc does not convert"


def _check_order(element: Process, context: Context) -> Iterator[str]:
    dropped = list(dropwhile(lambda stimulus: not isinstance(stimulus, NOT_CONVERTED), element.stimuli))
    for stimulus in dropped:
        if not isinstance(stimulus, NOT_CONVERTED):
            cause = f"it follows the unsupported {dropped[0].name!r}"
            yield f"the stimulus {stimulus.name or ''!r} of {element.name or ''!r} is dropped by am2inc because {cause}"


def _fix_order(element: Process, context: Context) -> bool:
    # The order of the stimuli has no meaning: each of them activates the process.
    element.stimuli = sorted(element.stimuli, key=lambda stimulus: isinstance(stimulus, NOT_CONVERTED))
    return True


RULES = (
    ModelRule(
        id="INC-ST-TYPE",
        title="unsupported stimulus",
        severity=Severity.WARNING,
        target=(Process, *NOT_CONVERTED),
        check=_check_type,
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
    ),
    ModelRule(
        id="INC-ST-ORDER",
        title="stimulus listed after an unsupported one",
        severity=Severity.WARNING,
        target=Process,
        check=_check_order,
        fix=_fix_order,
        rationale="am2inc stops at the first unsupported stimulus of a process and silently drops all stimuli after it.",
        remedy="Remove the unsupported stimulus, or list it last.",
        fails="""
<stimuliModel>
  <stimuli xsi:type="am:CustomStimulus" name="C"/>
  <stimuli xsi:type="am:PeriodicStimulus" name="P"/>
</stimuliModel>
<swModel>
  <tasks name="T" stimuli="C?type=CustomStimulus P?type=PeriodicStimulus"/>
</swModel>
""",
        edits={
            'stimuli="C?type=CustomStimulus P?type=PeriodicStimulus"': 'stimuli="P?type=PeriodicStimulus C?type=CustomStimulus"',
        },
    ),
)
