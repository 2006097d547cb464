"""Stimulus listed after an unsupported one."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import dropwhile

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Process
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._stimuli import NOT_CONVERTED


def _check(element: Process, context: Context) -> Iterator[str]:
    dropped = list(dropwhile(lambda stimulus: not isinstance(stimulus, NOT_CONVERTED), element.stimuli))
    for stimulus in dropped:
        if not isinstance(stimulus, NOT_CONVERTED):
            cause = f"it follows the unsupported {dropped[0].name!r}"
            yield f"the stimulus {stimulus.name or ''!r} of {element.name or ''!r} is dropped by am2inc because {cause}"


def _fix(element: Process, context: Context) -> bool:
    # The order of the stimuli has no meaning: each of them activates the process.
    element.stimuli = sorted(element.stimuli, key=lambda stimulus: isinstance(stimulus, NOT_CONVERTED))
    return True


RULE = ModelRule(
    id="INC-ST-ORDER",
    title="stimulus listed after an unsupported one",
    severity=Severity.WARNING,
    target=Process,
    check=_check,
    fix=_fix,
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
)
