"""Stimuli of every kind that real models use."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from synthesis.objects import Object
    from synthesis.plan import Plan

_PERIODS_MS = (5, 10, 20, 50, 100, 200)


def new_stimulus(plan: Plan, number: int, name: str) -> Object:
    """A stimulus whose kind follows from the number of its application, in the stimuli model."""
    stimulus = _KINDS[number % len(_KINDS)](plan, name)
    plan.place("stimuliModel", "stimuli", stimulus)
    return stimulus


def _periodic(plan: Plan, name: str) -> Object:
    period = plan.random.choice(_PERIODS_MS)
    return plan.new("PeriodicStimulus", name=name, recurrence=plan.time(period, "ms"), offset=plan.time(period // 5, "ms"))


def _periodic_with_jitter(plan: Plan, name: str) -> Object:
    stimulus = _periodic(plan, name)
    stimulus.values["jitter"] = plan.new(
        "TimeGaussDistribution",
        lowerBound=plan.time(-200, "us"),
        upperBound=plan.time(200, "us"),
        mean=plan.time(0, "us"),
        sd=plan.time(60, "us"),
    )
    stimulus.values["minDistance"] = plan.time(1, "ms")
    return stimulus


def _sporadic(plan: Plan, name: str) -> Object:
    lower = plan.random.randrange(700, 10000, 100)
    distance = plan.new(
        "TimeBoundaries", lowerBound=plan.time(lower, "us"), upperBound=plan.time(lower + 100, "us"), samplingType="Uniform"
    )
    return plan.new("RelativePeriodicStimulus", name=name, offset=plan.time(0, "ms"), nextOccurrence=distance)


def _synthetic(plan: Plan, name: str) -> Object:
    return plan.new(
        "PeriodicSyntheticStimulus",
        name=name,
        recurrence=plan.time(100, "ms"),
        occurrenceTimes=[plan.time(time, "ms") for time in (0, 7, 31)],
    )


def _burst(plan: Plan, name: str) -> Object:
    return plan.new(
        "PeriodicBurstStimulus",
        name=name,
        recurrence=plan.time(50, "ms"),
        burstLength=plan.time(10, "ms"),
        occurrenceMinDistance=plan.time(2, "ms"),
        occurrenceCount=4,
    )


def _arrival_curve(plan: Plan, name: str) -> Object:
    entries = [
        plan.new(
            "ArrivalCurveEntry",
            numberOfOccurrences=number,
            lowerTimeBorder=plan.time(4 * number - 6, "ms"),
            upperTimeBorder=plan.time(10 * number, "ms"),
        )
        for number in (2, 3, 4)
    ]
    return plan.new("ArrivalCurveStimulus", name=name, entries=entries)


def _variable_rate(plan: Plan, name: str) -> Object:
    clock = plan.new(
        "ClockFunction",
        name=f"Crankshaft of {name}",
        curveType="sine",
        period=plan.time(4, "s"),
        peakToPeak=plan.new("Frequency", value=80.0, unit="Hz"),
        yOffset=plan.new("Frequency", value=20.0, unit="Hz"),
    )
    plan.place("stimuliModel", "clocks", clock)
    return plan.new(
        "VariableRateStimulus",
        name=name,
        step=plan.time(1, "s"),
        occurrencesPerStep=plan.new("ContinuousValueStatistics", lowerBound=15.0, upperBound=120.0, average=60.0),
        maxIncreasePerStep=20.0,
        scenario=plan.new("Scenario", clock=clock),
    )


def _single(plan: Plan, name: str) -> Object:
    return plan.new("SingleStimulus", name=name, occurrence=plan.time(3, "ms"))


_KINDS: tuple[Callable[[Plan, str], Object], ...] = (
    _periodic,
    _sporadic,
    _periodic_with_jitter,
    _periodic,
    _synthetic,
    _periodic_with_jitter,
    _burst,
    _periodic,
    _arrival_curve,
    _variable_rate,
    _periodic,
    _sporadic,
    _single,
)
