"""Task that loses activations."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    ArrivalCurveStimulus,
    PeriodicBurstStimulus,
    PeriodicStimulus,
    PeriodicSyntheticStimulus,
    Stimulus,
    Task,
)
from amalthea_uros.metamodel.magnitudes import picoseconds
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.quantities import bounds
from amalthea_uros.validate.rule import ModelRule


def _check(element: Task, context: Context) -> Iterator[str]:
    # Nobody means a task that is never activated by the 0 that stands there by default.
    limit = max(1, element.effective("multiple_task_activation_limit"))
    for stimulus in element.stimuli:
        count = _at_once(stimulus)
        if count > limit:
            yield f"{stimulus.name!r} may activate {element.name!r} {count} times at once, which takes {limit} at most"


def _at_once(stimulus: Stimulus) -> int:
    """How often a stimulus may occur at the same moment."""
    match stimulus:
        case PeriodicStimulus():
            return _by_jitter(stimulus)
        case PeriodicBurstStimulus():
            count: int = stimulus.effective("occurrence_count")
            return 1 if picoseconds(stimulus.occurrence_min_distance) else count
        case PeriodicSyntheticStimulus():
            period = picoseconds(stimulus.recurrence)
            times = [time for each in stimulus.occurrence_times if (time := picoseconds(each)) is not None]
            # Times beyond the period meet those of the next rounds.
            return max(Counter(time % period if period else time for time in times).values(), default=1)
        case ArrivalCurveStimulus():
            return _by_curve(stimulus)
    return 1


def _by_jitter(stimulus: PeriodicStimulus) -> int:
    """One more for each period by which an occurrence may come later than another one."""
    period, (earliest, latest) = picoseconds(stimulus.recurrence), bounds(stimulus.jitter)
    if not period or picoseconds(stimulus.min_distance) or earliest is None or latest is None:
        return 1
    return int((latest - earliest) // period) + 1 if period > 0 else 1


def _by_curve(stimulus: ArrivalCurveStimulus) -> int:
    """One less than the fewest occurrences that take time; where none do, as many as may come in no time."""
    spans = [(entry.effective("number_of_occurrences"), picoseconds(entry.lower_time_border)) for entry in stimulus.entries]
    slow = [count for count, span in spans if span and count > 1]
    return min(slow) - 1 if slow else max((count for count, span in spans if span == 0), default=1)


RULE = ModelRule(
    id="TIM-ACTIVATION-LIMIT",
    title="more activations at a time than the task takes",
    severity=Severity.WARNING,
    target=Task,
    check=_check,
    rationale="The activations beyond the limit are lost: load and response times are computed as if each of them was served, and "
    "chains miss what was lost.",
    remedy="Raise the limit, or put the occurrences apart.",
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
    passes="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicBurstStimulus" name="B" occurrenceCount="2">
    <recurrence value="10" unit="ms"/>
    <burstLength value="1" unit="ms"/>
  </stimuli>
</stimuliModel>
<swModel>
  <tasks name="T" stimuli="B?type=PeriodicBurstStimulus" multipleTaskActivationLimit="2"/>
</swModel>
""",
)
