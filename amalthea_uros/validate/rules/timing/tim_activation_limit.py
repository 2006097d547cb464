"""Task that loses activations."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.timing.event_models.stimuli import event_model_of
from amalthea_uros.validate.rule import SystemProblem, SystemRule
from amalthea_uros.validate.system_context import SystemContext


def _check(context: SystemContext) -> Iterator[SystemProblem]:
    system = context.system
    for task in system.software.tasks:
        for stimulus in (system.stimuli_by_name[name] for name in task.stimuli if name in system.stimuli_by_name):
            events = event_model_of(stimulus, system)
            count = events.eta_plus(1) if events is not None else 1
            if count > task.activation_limit:
                message = (
                    f"{stimulus.name!r} may activate {task.name!r} {count} times at once, "
                    f"but its activation limit is {task.activation_limit}"
                )
                yield SystemProblem(task, message)


RULE = SystemRule(
    id="TIM-ACTIVATION-LIMIT",
    title="more simultaneous activations than the activation limit",
    severity=Severity.WARNING,
    check=_check,
    rationale="Activations beyond the limit are lost: loads and response times are computed as if every activation was executed, and "
    "chains lose data.",
    remedy="Raise the activation limit, or increase the distance between occurrences.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicBurstStimulus" name="B" occurrenceCount="3">
    <recurrence value="10" unit="ms"/>
    <burstLength value="1" unit="ms"/>
  </stimuli>
</stimuliModel>
<swModel>
  <tasks name="T" stimuli="B?type=PeriodicBurstStimulus" multipleTaskActivationLimit="2"/>
</swModel>
""",
    edits={'occurrenceCount="3"': 'occurrenceCount="2"'},
)
