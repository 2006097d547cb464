"""Stimulus behind one that is not converted."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import dropwhile

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Process
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._stimuli import NOT_CONVERTED


def _check(element: Process, context: Context) -> Iterator[str]:
    behind = list(dropwhile(lambda stimulus: not isinstance(stimulus, NOT_CONVERTED), element.stimuli))
    for stimulus in behind:
        if not isinstance(stimulus, NOT_CONVERTED):
            yield f"{stimulus.name!r} does not activate {element.name!r}, because it stands behind {behind[0].name!r}"


def _fix(element: Process, context: Context) -> bool:
    # In which order the stimuli stand means nothing: each of them activates the process.
    element.stimuli = sorted(element.stimuli, key=lambda stimulus: isinstance(stimulus, NOT_CONVERTED))
    return True


RULE = ModelRule(
    id="INC-ST-ORDER",
    title="stimulus behind one that is not converted",
    severity=Severity.WARNING,
    target=Process,
    check=_check,
    fix=_fix,
    rationale="At the first stimulus of a process that is not converted, all further ones are dropped without a word.",
    remedy="Remove the stimulus that is not converted, or list it last.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:CustomStimulus" name="C"/>
  <stimuli xsi:type="am:PeriodicStimulus" name="P"/>
</stimuliModel>
<swModel>
  <tasks name="T" stimuli="C?type=CustomStimulus P?type=PeriodicStimulus"/>
</swModel>
""",
    passes="""
<stimuliModel>
  <stimuli xsi:type="am:CustomStimulus" name="C"/>
  <stimuli xsi:type="am:PeriodicStimulus" name="P"/>
</stimuliModel>
<swModel>
  <tasks name="T" stimuli="P?type=PeriodicStimulus C?type=CustomStimulus"/>
</swModel>
""",
)
