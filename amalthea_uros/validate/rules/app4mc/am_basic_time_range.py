"""Time out of range."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    ArrivalCurveEntry,
    ClockFunction,
    ClockStep,
    ClockStepList,
    DataAgeTime,
    DelayConstraint,
    EventChainLatencyConstraint,
    FixedPeriodic,
    PeriodicActivation,
    PeriodicSyntheticStimulus,
    RepetitionConstraint,
    SingleActivation,
    SingleStimulus,
    SynchronizationConstraint,
    Time,
)
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule

_POSITIVE, _NOT_NEGATIVE = "greater than 0", "0 or more"

#: The smallest allowed value in any unit: times are whole numbers.
_MINIMUM = {_POSITIVE: 1, _NOT_NEGATIVE: 0}

#: The required range of times, by class and feature; all other times are unrestricted.
_ROLES: tuple[tuple[type[Element], str, str], ...] = (
    (FixedPeriodic, "recurrence", _POSITIVE),
    (FixedPeriodic, "offset", _NOT_NEGATIVE),
    (SingleStimulus, "occurrence", _NOT_NEGATIVE),
    (PeriodicSyntheticStimulus, "occurrence_times", _NOT_NEGATIVE),
    (ArrivalCurveEntry, "lower_time_border", _NOT_NEGATIVE),
    (ArrivalCurveEntry, "upper_time_border", _NOT_NEGATIVE),
    (PeriodicActivation, "recurrence", _POSITIVE),
    (PeriodicActivation, "offset", _NOT_NEGATIVE),
    (PeriodicActivation, "min", _NOT_NEGATIVE),
    (PeriodicActivation, "max", _NOT_NEGATIVE),
    (SingleActivation, "min", _NOT_NEGATIVE),
    (SingleActivation, "max", _NOT_NEGATIVE),
    (ClockFunction, "period", _POSITIVE),
    (ClockFunction, "x_offset", _NOT_NEGATIVE),
    (ClockStepList, "period", _POSITIVE),
    (ClockStep, "time", _NOT_NEGATIVE),
    (DataAgeTime, "minimum_time", _NOT_NEGATIVE),
    (DataAgeTime, "maximum_time", _NOT_NEGATIVE),
    (DelayConstraint, "lower", _NOT_NEGATIVE),
    (DelayConstraint, "upper", _NOT_NEGATIVE),
    (EventChainLatencyConstraint, "minimum", _NOT_NEGATIVE),
    (EventChainLatencyConstraint, "maximum", _NOT_NEGATIVE),
    (RepetitionConstraint, "lower", _NOT_NEGATIVE),
    (RepetitionConstraint, "upper", _NOT_NEGATIVE),
    (RepetitionConstraint, "jitter", _NOT_NEGATIVE),
    (RepetitionConstraint, "period", _NOT_NEGATIVE),
    (SynchronizationConstraint, "tolerance", _NOT_NEGATIVE),
)


def _check(element: Time, context: Context) -> Iterator[str]:
    feature, required = context.once(_required_ranges).get(element, ("", ""))
    value = element.value or 0
    if required and value < _MINIMUM[required]:
        yield f"the {feature.replace('_', ' ')} is {value} {element.unit or ''}".rstrip() + f", but must be {required}"


def _required_ranges(context: Context) -> dict[Time, tuple[str, str]]:
    found: dict[Time, tuple[str, str]] = {}
    for cls, feature, required in _ROLES:
        for holder in context.all(cls):
            held = getattr(holder, feature)
            found.update((time, (feature, required)) for time in (held if isinstance(held, list) else [held]))
    return found


RULE = ModelRule(
    id="AM-Basic-Time-Range",
    title="time out of range",
    severity=Severity.ERROR,
    target=Time,
    check=_check,
    rationale="Periods must be positive; offsets, points in time and bounds must not be negative. APP4MC's validation also reports it.",
    remedy="Set periods to more than 0, and offsets, points in time and bounds to 0 or more.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S">
    <recurrence value="0" unit="ms"/>
    <offset value="-1" unit="ms"/>
  </stimuli>
</stimuliModel>
""",
    edits={
        'value="0"': 'value="1"',
        'value="-1"': 'value="0"',
    },
)
