"""Process without an activation."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    ISR,
    EventStimulus,
    InterProcessStimulus,
    InterProcessTrigger,
    Process,
    Stimulus,
    Task,
)
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.execution import executing
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.wording import listed


def _check(element: Process, context: Context) -> Iterator[str]:
    if isinstance(element, Task | ISR) and not any(_occurs(stimulus, context) for stimulus in element.stimuli):
        if element.stimuli:
            yield f"{element.name!r} is never activated: nothing triggers {listed(element.stimuli)}"
        else:
            yield f"{element.name!r} is never activated: it has no stimulus"


def _occurs(stimulus: Stimulus, context: Context) -> bool:
    """Whether a stimulus comes from the environment, or is triggered by the model."""
    match stimulus:
        case InterProcessStimulus(unresolved=None):
            return stimulus in context.once(_triggered)
        case EventStimulus(unresolved=None):
            return bool(stimulus.triggering_events)
    return True


def _triggered(context: Context) -> set[Stimulus]:
    """The stimuli that a process triggers."""
    triggers = (trigger for trigger in context.all(InterProcessTrigger) if executing(trigger, context))
    return {trigger.stimulus for trigger in triggers if trigger.stimulus is not None}


RULE = ModelRule(
    id="TIM-STIMULUS",
    title="process without an activation",
    severity=Severity.WARNING,
    target=Process,
    check=_check,
    rationale="The process never runs, so its response time and its load are meaningless.",
    remedy="Add a stimulus, trigger the existing one, or remove the process.",
    fails="""
<swModel>
  <tasks name="T"/>
</swModel>
""",
    passes="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S"/>
</stimuliModel>
<swModel>
  <tasks name="T" stimuli="S?type=PeriodicStimulus"/>
</swModel>
""",
)
