"""Stimulus without a minimum interarrival time."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    ArrivalCurveEntry,
    ArrivalCurveStimulus,
    CustomStimulus,
    PeriodicBurstStimulus,
    PeriodicStimulus,
    PeriodicSyntheticStimulus,
    RelativePeriodicStimulus,
    Stimulus,
    VariableRateStimulus,
)
from amalthea_uros.metamodel.magnitudes import picoseconds
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.quantities import bounds
from amalthea_uros.validate.rule import ModelRule


def _check(element: Stimulus, context: Context) -> Iterator[str]:
    match element:
        case PeriodicStimulus() | PeriodicSyntheticStimulus() | PeriodicBurstStimulus():
            if not (picoseconds(element.recurrence) or 0) > 0:
                yield f"stimulus {element.name!r} has no positive recurrence with a unit"
            if isinstance(element, PeriodicStimulus) and element.jitter is not None and None in bounds(element.jitter):
                yield f"the jitter of stimulus {element.name!r} has no lower or no upper bound"
        case RelativePeriodicStimulus():
            if not (bounds(element.next_occurrence)[0] or 0) > 0:
                yield f"stimulus {element.name!r} has no positive minimum distance with a unit"
        case ArrivalCurveStimulus():
            if not any(_limits(entry) for entry in element.entries):
                yield f"stimulus {element.name!r} has no positive lower time border with a unit for two or more occurrences"
        case VariableRateStimulus(scenario=None):
            if not (picoseconds(element.step) or 0) > 0 or not (bounds(element.occurrences_per_step)[1] or 0) > 0:
                yield f"the maximum number of occurrences per step of stimulus {element.name!r} is unknown"
        case CustomStimulus():
            yield f"the activation pattern of custom stimulus {element.name!r} is unknown"


def _limits(entry: ArrivalCurveEntry) -> bool:
    """Whether an entry defines a minimum time between occurrences."""
    return entry.effective("number_of_occurrences") > 1 and (picoseconds(entry.lower_time_border) or 0) > 0


RULE = ModelRule(
    id="TIM-PERIOD",
    title="stimulus without a minimum interarrival time",
    severity=Severity.WARNING,
    target=Stimulus,
    check=_check,
    rationale="The number of activations is unbounded, and so is the load.",
    remedy="Set a positive recurrence or minimum distance, with its unit.",
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
