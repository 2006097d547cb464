"""Stimulus without a distance between its occurrences."""

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
                yield f"the stimulus {element.name!r} has no recurrence above zero with a unit"
            if isinstance(element, PeriodicStimulus) and element.jitter is not None and None in bounds(element.jitter):
                yield f"the jitter of the stimulus {element.name!r} lacks a bound"
        case RelativePeriodicStimulus():
            if not (bounds(element.next_occurrence)[0] or 0) > 0:
                yield f"the stimulus {element.name!r} has no least distance above zero with a unit"
        case ArrivalCurveStimulus():
            if not any(_limits(entry) for entry in element.entries):
                yield f"no entry of {element.name!r} has a lower border above zero with a unit for two or more occurrences"
        case VariableRateStimulus(scenario=None):
            if not (picoseconds(element.step) or 0) > 0 or not (bounds(element.occurrences_per_step)[1] or 0) > 0:
                yield f"nothing says how often the stimulus {element.name!r} occurs at most in a step"
        case CustomStimulus():
            yield f"nothing says how often the custom stimulus {element.name!r} occurs"


def _limits(entry: ArrivalCurveEntry) -> bool:
    """Whether an entry says how close occurrences are at most."""
    return entry.effective("number_of_occurrences") > 1 and (picoseconds(entry.lower_time_border) or 0) > 0


RULE = ModelRule(
    id="TIM-PERIOD",
    title="stimulus without a distance between its occurrences",
    severity=Severity.WARNING,
    target=Stimulus,
    check=_check,
    rationale="Nothing bounds how often it occurs, and with it the load.",
    remedy="State a recurrence or a least distance above zero, with its unit.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S"/>
</stimuliModel>
""",
    passes="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S">
    <recurrence value="1" unit="ms"/>
  </stimuli>
</stimuliModel>
""",
)
