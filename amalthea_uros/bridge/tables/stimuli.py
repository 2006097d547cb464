"""The stimuli model."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from amalthea_uros.bridge.basics.codecs import (
    FREQUENCY,
    PLAIN,
    TIME,
    TIMES,
    Codec,
    all_references,
    build_time,
    marked,
    reference,
    same_names,
)
from amalthea_uros.bridge.basics.context import Building, Extracting
from amalthea_uros.bridge.basics.entries import ClassEntry, ClassTable, Columns, all_parts, part, parts
from amalthea_uros.bridge.basics.kinds import ObjectKind
from amalthea_uros.bridge.tables.conditions import ASSIGNMENTS, CONDITION
from amalthea_uros.bridge.tables.distributions import NUMBER, TIME_SPAN
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.magnitudes import in_one_unit, picoseconds
from amalthea_uros.perf import stimuli as perf

#: AMALTHEA has no attribute for the source of a counter; the key also says whether the phase is known.
_SOURCE, _SOURCE_WITHOUT_PHASE = "source", "sourceWithoutPhase"
#: Nor for irregular arrivals of the source, and for times that are late.
_PERIOD_OF_ARRIVALS, _JITTER_OF_ARRIVALS, _JITTER = "arrivalPeriod", "arrivalJitter", "jitter"


class _Counters(ClassTable):
    """Counters, with custom properties for the message or timer that they represent: its name, whether its phase is known, arrivals."""

    def build(self, item: Any, context: Building) -> Any:
        element = super().build(item, context)
        if item.source or not item.is_phase_known:
            key = _SOURCE if item.is_phase_known else _SOURCE_WITHOUT_PHASE
            element.custom_properties.append(am.CustomProperty(key=key, value=am.StringObject(value=item.source)))
        if item.arrivals is not None:
            times = {_PERIOD_OF_ARRIVALS: item.arrivals.period, _JITTER_OF_ARRIVALS: item.arrivals.jitter}
            element.custom_properties += [
                am.CustomProperty(key=key, value=build_time(time)) for key, time in times.items() if time is not None
            ]
        if item.jitter:
            element.custom_properties.append(am.CustomProperty(key=_JITTER, value=am.LongObject(value=item.jitter)))
        return element

    def extract(self, element: Any, context: Extracting) -> Any:
        numbers = {item.key: item.value.value for item in element.custom_properties if isinstance(item.value, am.LongObject)}
        stated = {item.key: item.value.value for item in element.custom_properties if isinstance(item.value, am.StringObject)}
        is_phase_known = _SOURCE_WITHOUT_PHASE not in stated
        source = stated.get(_SOURCE if is_phase_known else _SOURCE_WITHOUT_PHASE)
        return replace(
            super().extract(element, context),
            source=source or "",
            is_phase_known=is_phase_known,
            arrivals=_extract_arrivals(element),
            jitter=numbers.get(_JITTER) or 0,
        )


def _extract_arrivals(element: Any) -> perf.Arrivals | None:
    times = {item.key: picoseconds(item.value) for item in element.custom_properties if isinstance(item.value, am.Time)}
    jitter = times.get(_JITTER_OF_ARRIVALS)
    return None if jitter is None else perf.Arrivals(period=times.get(_PERIOD_OF_ARRIVALS), jitter=jitter)


#: Numbers that are not given have these values in every version: prescaler 1, offset 0.
COUNTER = part(_Counters(ClassEntry(perf.Counter, am.Counter, prescaler=PLAIN, offset=PLAIN)))

_COMMON: Columns = {"condition": ("execution_condition", CONDITION), "assignments": ("set_mode_value_list", ASSIGNMENTS)}
_PERIOD: Columns = {"period": ("recurrence", TIME), "offset": TIME}

_SCENARIO = ClassTable(
    ClassEntry(
        perf.Scenario,
        am.Scenario,
        clock=reference(ObjectKind.STIMULUS_CLOCK),
        offset="sampling_offset",
        recurrence="sampling_recurrence",
    )
)
_POINTS = ClassTable(
    ClassEntry(
        perf.ArrivalCurvePoint,
        am.ArrivalCurveEntry,
        occurrences="number_of_occurrences",
        lower=("lower_time_border", TIME),
        upper=("upper_time_border", TIME),
    )
)


def _build_distance(value: Any, context: Building) -> Any:
    """INCHRON's importer takes the two bounds as if they had the same unit (am2inc, stimuliModel.cpp)."""
    made = TIME_SPAN.build(value, context)
    if isinstance(made, am.TimeUniformDistribution) and made.lower_bound and made.upper_bound:
        in_one_unit(made.lower_bound, made.upper_bound)
    return made


class _StimulusTable(ClassTable):
    """Stimuli; what is incomplete activates at an unknown rate, like a custom one."""

    def extract(self, element: Element, context: Extracting) -> Any:
        entry = self.by_amalthea_class.get(type(element))
        found = None if entry is None else entry.complete(element, context, strictly=True)
        return found or perf.Custom(name=context.names[element], description="incomplete", origin=context.location(element))


STIMULI: ClassTable = _StimulusTable(
    ClassEntry(perf.Periodic, am.PeriodicStimulus, **_PERIOD, jitter=TIME_SPAN, min_distance=TIME, **_COMMON),
    ClassEntry(
        perf.RelativePeriodic,
        am.RelativePeriodicStimulus,
        offset=TIME,
        distance=("next_occurrence", Codec(_build_distance, TIME_SPAN.extract)),
        has_maximum=("custom_properties", marked("maximumKnown", default=True)),
        **_COMMON,
    ),
    ClassEntry(perf.Synthetic, am.PeriodicSyntheticStimulus, **_PERIOD, times=("occurrence_times", TIMES), **_COMMON),
    ClassEntry(
        perf.Burst,
        am.PeriodicBurstStimulus,
        **_PERIOD,
        length=("burst_length", TIME),
        distance=("occurrence_min_distance", TIME),
        count="occurrence_count",
        **_COMMON,
    ),
    ClassEntry(perf.Single, am.SingleStimulus, time=("occurrence", TIME), **_COMMON),
    ClassEntry(
        perf.VariableRate,
        am.VariableRateStimulus,
        step=TIME,
        rate=("occurrences_per_step", NUMBER),
        max_increase="max_increase_per_step",
        max_decrease="max_decrease_per_step",
        scenario=part(_SCENARIO),
        **_COMMON,
    ),
    ClassEntry(perf.ArrivalCurve, am.ArrivalCurveStimulus, points=("entries", parts(_POINTS)), **_COMMON),
    ClassEntry(perf.InterProcess, am.InterProcessStimulus, counter=COUNTER, **_COMMON),
    ClassEntry(
        perf.EventTriggered,
        am.EventStimulus,
        events=("triggering_events", all_references(ObjectKind.EVENT)),
        counter=COUNTER,
        **_COMMON,
    ),
    ClassEntry(perf.Custom, am.CustomStimulus, description=PLAIN, **_COMMON),
)

_STEPS = ClassTable(ClassEntry(perf.ClockStep, am.ClockStep, time=TIME, frequency=FREQUENCY))

CLOCKS = ClassTable(
    ClassEntry(
        perf.ClockFunction,
        am.ClockFunction,
        curve=("curve_type", same_names(perf.Curve, am.CurveType)),
        period=TIME,
        lowest=("y_offset", FREQUENCY),
        swing=("peak_to_peak", FREQUENCY),
        shift=("x_offset", TIME),
    ),
    ClassEntry(perf.ClockSteps, am.ClockStepList, steps=("entries", all_parts(_STEPS)), period=TIME),
)
