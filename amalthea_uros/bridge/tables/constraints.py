"""Timing constraints and requirements."""

from __future__ import annotations

from typing import Any

from amalthea_uros.bridge.basics.codecs import FLOAT, FREQUENCY, TIME, Codec, reference, references, same_names, time_property
from amalthea_uros.bridge.basics.context import Building, Extracting
from amalthea_uros.bridge.basics.entries import ClassEntry, ClassTable, part
from amalthea_uros.bridge.basics.kinds import ObjectKind
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.perf import constraints as perf

_EVENT = reference(ObjectKind.EVENT)
#: AMALTHEA limits no jitter of a latency or of a time of jobs.
_JITTER = time_property("jitter")
_EVERY = "multiple_occurrences_allowed"

CONSTRAINTS = ClassTable(
    ClassEntry(
        perf.LatencyConstraint,
        am.EventChainLatencyConstraint,
        chain=("scope", reference(ObjectKind.CHAIN)),
        kind=("type", same_names(perf.LatencyKind, am.LatencyType)),
        minimum=TIME,
        maximum=TIME,
        jitter=("custom_properties", _JITTER),
    ),
    ClassEntry(
        perf.DelayConstraint,
        am.DelayConstraint,
        source=_EVENT,
        target=_EVENT,
        matching=("mapping_type", same_names(perf.Matching, am.MappingType, ONE_TO_ONE="ONETOONE")),
        lower=TIME,
        upper=TIME,
    ),
    ClassEntry(
        perf.RepetitionConstraint,
        am.RepetitionConstraint,
        event=_EVENT,
        # 0 is what the metamodel gives where nothing is stated.
        span=Codec(lambda value, _: value, lambda value, _context, _element: value or 1),
        lower=TIME,
        upper=TIME,
        jitter=TIME,
        period=TIME,
    ),
    ClassEntry(
        perf.EventSynchronization,
        am.EventSynchronizationConstraint,
        events=references(ObjectKind.EVENT),
        tolerance=TIME,
        every_occurrence=_EVERY,
    ),
    ClassEntry(
        perf.ChainSynchronization,
        am.EventChainSynchronizationConstraint,
        chains=("scope", references(ObjectKind.CHAIN)),
        end=("type", same_names(perf.ChainEnd, am.SynchronizationType)),
        tolerance=TIME,
        every_occurrence=_EVERY,
    ),
)


class _Ages(ClassEntry):
    """Data age: as a time or as a number of cycles, which are two classes in AMALTHEA."""

    def fill(self, element: Any, item: Any, context: Building) -> Element:
        found = super().fill(element, item, context)
        if (item.earliest_cycle, item.latest_cycle) != (None, None):
            element.data_age = am.DataAgeCycle(minimum_cycle=item.earliest_cycle, maximum_cycle=item.latest_cycle)
        elif (item.earliest, item.latest) != (None, None):
            times = {"minimum_time": item.earliest, "maximum_time": item.latest}
            element.data_age = am.DataAgeTime(**{name: TIME.build(time, context) for name, time in times.items()})
        return found

    def extract(self, element: Any, context: Extracting) -> perf.DataAgeConstraint | None:
        found = super().extract(element, context)
        if found is None:
            return None
        match element.data_age:
            case am.DataAgeCycle(minimum_cycle=earliest, maximum_cycle=latest):
                values: dict[str, Any] = {"earliest_cycle": earliest, "latest_cycle": latest}
            case am.DataAgeTime(minimum_time=earliest, maximum_time=latest):
                values = {
                    "earliest": TIME.extract(earliest, context, element),
                    "latest": TIME.extract(latest, context, element),
                }
            case _:
                values = {}
        return perf.DataAgeConstraint(
            name=found.name, origin=found.origin, runnable=found.runnable, label=found.label, **values
        )


DATA_AGES = ClassTable(
    _Ages(
        perf.DataAgeConstraint, am.DataAgeConstraint, runnable=reference(ObjectKind.RUNNABLE), label=reference(ObjectKind.DATA)
    )
)

# Requirements

_BOUND = ("limit_type", same_names(perf.Bound, am.LimitType, UPPER="UPPER_LIMIT", LOWER="LOWER_LIMIT"))
_VALUE = "limit_value"
_FLOAT = ("limit_value", FLOAT)

_LIMITS = ClassTable(
    ClassEntry(
        perf.TimeLimit,
        am.TimeRequirementLimit,
        metric=same_names(perf.TimeMetric, am.TimeMetric, END_TO_END="ENDTOEND"),
        value=("limit_value", TIME),
        bound=_BOUND,
    ),
    ClassEntry(
        perf.CountLimit,
        am.CountRequirementLimit,
        metric=same_names(
            perf.CountMetric,
            am.CountMetric,
            LOST_ACTIVATIONS="MTA_LIMIT_EXCEEDING",
            CACHE_HITS="CACHE_HIT",
            CACHE_MISSES="CACHE_MISS",
        ),
        value=_VALUE,
        bound=_BOUND,
    ),
    ClassEntry(
        perf.LoadLimit,
        am.CPUPercentageRequirementLimit,
        metric=same_names(perf.LoadMetric, am.CPUPercentageMetric, **{m.name: f"CPU{m.name}" for m in perf.LoadMetric}),
        value=_FLOAT,
        bound=_BOUND,
        core=("hardware_context", reference(ObjectKind.MODULE)),
    ),
    ClassEntry(
        perf.RatioLimit,
        am.PercentageRequirementLimit,
        metric=same_names(
            perf.RatioMetric,
            am.PercentageMetric,
            CORE_EXECUTION_TIME="CORE_EXECUTION_TIME_RELATIVE",
            MEMORY_ACCESS_TIME="MEMORY_ACCESS_TIME_RELATIVE",
            OS_OVERHEAD="OS_OVERHEAD_RELATIVE",
            CACHE_HITS="CACHE_HIT_RATIO",
            CACHE_MISSES="CACHE_MISS_RATIO",
        ),
        value=_FLOAT,
        bound=_BOUND,
    ),
    ClassEntry(
        perf.FrequencyLimit,
        am.FrequencyRequirementLimit,
        metric=same_names(
            perf.FrequencyMetric, am.FrequencyMetric, CACHE_HITS="CACHE_HIT_FREQUENCY", CACHE_MISSES="CACHE_MISS_FREQUENCY"
        ),
        value=("limit_value", FREQUENCY),
        bound=_BOUND,
    ),
)
_LIMIT = part(_LIMITS)


def _always_kept(metric: perf.TimeMetric) -> perf.TimeLimit:
    """A limit of a time that no job misses: every response takes time, and checkers of models refuse a limit of zero for it."""
    least = 1 if metric is perf.TimeMetric.RESPONSE_TIME else 0
    return perf.TimeLimit(metric=metric, value=least, bound=perf.Bound.LOWER)


def _build_limit(limit: perf.Limit, context: Building, element: am.Requirement) -> None:
    """Set the limit of a requirement: for a jitter one that is always kept, on the same time, and a property with the jitter."""
    if isinstance(limit, perf.JitterLimit):
        element.custom_properties += _JITTER.build(limit.value, context)
        limit = _always_kept(limit.metric)
    element.limit = _LIMIT.build(limit, context)


def _extract_limit(element: am.Requirement, context: Extracting) -> perf.Limit | None:
    """The way back; None if there is none, or it is incomplete. A limit that somebody else states is not replaced by a jitter."""
    limit: perf.Limit | None = None if element.limit is None else _LIMIT.extract(element.limit, context, element)
    jitter = _JITTER.extract(element.custom_properties, context, element)
    if isinstance(limit, perf.TimeLimit) and jitter is not None and limit == _always_kept(limit.metric):
        return perf.JitterLimit(metric=limit.metric, value=jitter)
    return limit


_SEVERITY = same_names(perf.RequirementSeverity, am.Severity)


def build_requirement(requirement: perf.Requirement, context: Building) -> am.Requirement:
    """A requirement on a process or on a runnable."""
    context.at(requirement)
    element: am.Requirement
    if requirement.runnable is not None:
        runnable = reference(ObjectKind.RUNNABLE).build(requirement.runnable, context)
        element = am.RunnableRequirement(name=requirement.name, runnable=runnable)
    else:
        process = reference(ObjectKind.PROCESS).build(requirement.process, context)
        element = am.ProcessRequirement(name=requirement.name, process=process)
    _build_limit(requirement.limit, context, element)
    if requirement.severity is not None:
        element.severity = _SEVERITY.build(requirement.severity, context)
    if requirement.origin is not None:
        context.origins[element] = requirement.origin
    return element


def extract_requirement(element: am.Requirement, context: Extracting) -> perf.Requirement | None:
    """The way back; None, with a note, if it is one on something else, or has no limit."""
    process: str | None = None
    runnable: str | None = None
    match element:
        case am.ProcessRequirement(process=holder):
            process = reference(ObjectKind.PROCESS).extract(holder, context, element)
        case am.RunnableRequirement(runnable=holder):
            runnable = reference(ObjectKind.RUNNABLE).extract(holder, context, element)
        case _:
            context.leave_out(element)
            return None
    limit = _extract_limit(element, context)
    if limit is None or (process is None and runnable is None):
        context.note("EXT004", f"{type(element).__name__} ignored: it has no object or no limit", element)
        return None
    return perf.Requirement(
        name=element.name or "",
        origin=context.location(element),
        process=process,
        runnable=runnable,
        limit=limit,
        severity=_SEVERITY.extract(element.severity, context, element),
    )


# Order

_ORDERING = same_names(
    perf.Ordering,
    am.RunnableOrderType,
    IMMEDIATE_ANYWHERE="IMMEDIATE_SUCCESSOR_ANY_SEQUENCE",
    IMMEDIATE_AT_START="IMMEDIATE_SUCCESSOR_START_SEQUENCE",
    IMMEDIATE_AT_END="IMMEDIATE_SUCCESSOR_END_SEQUENCE",
)
_GROUPS = Codec(
    lambda groups, context: [
        am.RunnableEntityGroup(runnables=references(ObjectKind.RUNNABLE).build(g, context)) for g in groups
    ],
    lambda values, context, _element: tuple(
        references(ObjectKind.RUNNABLE).extract(group.runnables, context, group) for group in values
    ),
)

ORDERS = ClassTable(
    ClassEntry(
        perf.OrderConstraint,
        am.RunnableSequencingConstraint,
        groups=("runnable_groups", _GROUPS),
        ordering=("order_type", _ORDERING),
        processes=("process_scope", references(ObjectKind.PROCESS)),
    )
)


_DATA_GROUPS: dict[perf.DataGroupKind, type[am.DataCoherencyGroup | am.DataStabilityGroup]] = {
    perf.DataGroupKind.COHERENCY: am.DataCoherencyGroup,
    perf.DataGroupKind.STABILITY: am.DataStabilityGroup,
}
_LABELS = references(ObjectKind.DATA)


def build_data_group(group: perf.DataGroup, context: Building) -> am.DataCoherencyGroup | am.DataStabilityGroup:
    """Labels that have to be kept consistent."""
    context.at(group)
    element = _DATA_GROUPS[group.kind](name=group.name, labels=_LABELS.build(group.labels, context))
    if group.origin is not None:
        context.origins[element] = group.origin
    return element


def extract_data_group(element: am.DataCoherencyGroup | am.DataStabilityGroup, context: Extracting) -> perf.DataGroup:
    """The way back."""
    is_stable = isinstance(element, am.DataStabilityGroup)
    return perf.DataGroup(
        name=element.name or "",
        kind=perf.DataGroupKind.STABILITY if is_stable else perf.DataGroupKind.COHERENCY,
        labels=_LABELS.extract(element.labels, context, element),
        origin=context.location(element),
    )
