"""Bounds with different units."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import RelativePeriodicStimulus, Time, TimeUniformDistribution
from amalthea_uros.metamodel.magnitudes import TIMES, picoseconds
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: RelativePeriodicStimulus, context: Context) -> Iterator[str]:
    if len({bound.unit for bound in _bounds(element)}) > 1:
        yield f"the bounds of the next occurrence of the stimulus {element.name or ''!r} have different units"


def _bounds(stimulus: RelativePeriodicStimulus) -> list[Time]:
    distance = stimulus.next_occurrence
    bounds = [distance.lower_bound, distance.upper_bound] if isinstance(distance, TimeUniformDistribution) else []
    return [bound for bound in bounds if bound is not None]


def _fix(element: RelativePeriodicStimulus, context: Context) -> bool:
    """State both bounds in the finer unit, in which both are whole numbers."""
    times = [(bound, picoseconds(bound)) for bound in _bounds(element)]
    unit = min((bound.unit for bound, _ in times if bound.unit in TIMES), key=TIMES.__getitem__, default=None)
    if unit is None or any(time is None for _, time in times):
        return False
    for bound, time in times:
        bound.value, bound.unit = (time or 0) // TIMES[unit], unit
    return True


RULE = ModelRule(
    id="INC-ST-RELPER-UNIT",
    title="bounds with different units",
    severity=Severity.WARNING,
    target=RelativePeriodicStimulus,
    check=_check,
    fix=_fix,
    rationale="am2inc silently computes a distance that is wrong by a power of 1000.",
    remedy="Use the same unit for both bounds.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:RelativePeriodicStimulus" name="S">
    <nextOccurrence xsi:type="am:TimeUniformDistribution">
      <lowerBound value="1" unit="ms"/>
      <upperBound value="2000" unit="us"/>
    </nextOccurrence>
  </stimuli>
</stimuliModel>
""",
    edits={'value="2000" unit="us"': 'value="2" unit="ms"'},
)
