"""What processes execute, wait for and depend on."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import isfinite

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import model_rule
from amalthea_uros.validate.scheduling import policy
from amalthea_uros.validate.wording import joined


def by_label(conditions: Iterable[Element]) -> dict[am.ModeLabel, tuple[dict[str, None], dict[str, None]]]:
    """The literals that each mode label is compared with, for equality and for inequality."""
    found: dict[am.ModeLabel, tuple[dict[str, None], dict[str, None]]] = {}
    for condition in conditions:
        if not isinstance(condition, am.ModeValueCondition) or condition.label is None or condition.value is None:
            continue
        if isinstance(condition.label.mode, am.EnumMode) and condition.relation in _RELATIONS:
            found.setdefault(condition.label, ({}, {}))[_RELATIONS.index(condition.relation)][condition.value] = None
    return found


_RELATIONS = (am.RelationalOperator.EQUAL, am.RelationalOperator.NOT_EQUAL)


@model_rule("TA-Software-ModeConditionConjunctionAlwaysFalse", am.ConditionConjunction, am.ModeConditionConjunction)
def _check_conjunction(element: am.ConditionConjunction | am.ModeConditionConjunction, context: Context) -> Iterator[str]:
    for label, (required, excluded) in by_label(element.entries).items():
        if len(required) > 1:
            yield f"{label.name!r} must equal {joined(map(repr, required))} at the same time"
        if len(excluded) > 1:
            # With a third literal this can be true, but APP4MC reports it anyway.
            yield f"{label.name!r} must differ from {joined(map(repr, excluded))}"
        for literal in required:
            if literal in excluded:
                yield f"{label.name!r} must both equal and differ from {literal!r}"


@model_rule("TA-Software-ModeConditionDisjunctionAlwaysTrue", am.ConditionDisjunction, am.ModeConditionDisjunction)
def _check_disjunction(element: am.ConditionDisjunction | am.ModeConditionDisjunction, context: Context) -> Iterator[str]:
    # Only single conditions count, not those within conjunctions.
    for label, (accepted, rejected) in by_label(element.entries).items():
        literals = _literals(label)
        if literals and literals <= set(accepted):
            yield f"{label.name!r} may have any of its literals"
        for literal in accepted:
            if literal in rejected:
                yield f"{label.name!r} may equal {literal!r} or differ from it"


def _literals(label: am.ModeLabel) -> set[str | None]:
    return {literal.name for literal in label.mode.literals} if isinstance(label.mode, am.EnumMode) else set()


@model_rule("TA-Software-RunnableCall", am.RunnableCall)
def _check_call(element: am.RunnableCall, context: Context) -> Iterator[str]:
    caller = element.enclosing(am.Runnable)
    if caller is not None and element.runnable is caller:
        yield f"{caller.name!r} calls itself"


@model_rule("TA-Software-ServerCall", am.ServerCall)
def _check_server_call(element: am.ServerCall, context: Context) -> Iterator[str]:
    caller = element.enclosing(am.Runnable)
    if caller is not None and element.server_runnable is caller:
        yield f"{caller.name!r} calls itself as a server"


def is_per_cycle(feature: am.HwFeature) -> bool:
    """Whether a feature defines the IPC, judged by its name and the name of its category."""
    return name_of(feature.container).lower() == "instructions" and name_of(feature).startswith("IPC_")


@model_rule("TA-Hardware-HWFIPCMustBePositive", am.HwFeature)
def _check_positive(element: am.HwFeature, context: Context) -> Iterator[str]:
    value: float = element.effective("value")
    if is_per_cycle(element) and isfinite(value) and value <= 0:
        yield f"the IPC {element.name!r} is {value}, but must be greater than 0"


@model_rule("TA-Hardware-PUDIPCMissing", am.ProcessingUnitDefinition)
def _check_missing(element: am.ProcessingUnitDefinition, context: Context) -> Iterator[str]:
    count = sum(is_per_cycle(feature) for feature in element.features)
    if element.pu_type is am.PuType.CPU and count == 0:
        yield f"IPC of {element.name!r} is not defined; assuming 1.0"
    elif element.pu_type is am.PuType.CPU and count > 1:
        yield f"IPC of {element.name!r} is defined {count} times; using the first value"


@model_rule("TA-Constraints-EDFTaskMustHaveDeadline", am.Task)
def _check_edftaskmusthavedeadline(element: am.Task, context: Context) -> Iterator[str]:
    if element in context.once(_by_deadline) and element not in context.once(_limited):
        yield f"{element.name!r} is scheduled by EDF, but no requirement limits its response time"


def _by_deadline(context: Context) -> set[am.Task]:
    allocations = context.all(am.TaskAllocation)
    return {
        allocation.task
        for allocation in allocations
        if allocation.task is not None and policy(allocation.scheduler) == "EarliestDeadlineFirst"
    }


def _limited(context: Context) -> set[am.AbstractProcess]:
    # Deadlines in scheduling parameters do not count: APP4MC's rule is older than these parameters.
    return {
        requirement.process
        for requirement in context.all(am.ProcessRequirement)
        if requirement.process is not None
        and isinstance(requirement.limit, am.TimeRequirementLimit)
        and requirement.limit.limit_type is am.LimitType.UPPER_LIMIT
        and requirement.limit.metric is am.TimeMetric.RESPONSE_TIME
    }


@model_rule("TA-Stimuli-ArrivalCurveStimulus", am.OsEvent)
def _check_arrivalcurvestimulus(element: am.OsEvent, context: Context) -> Iterator[str]:
    # APP4MC uses this id for the rule, although it names another subject.
    if element in context.once(_awaited) and element not in context.once(_set):
        yield f"{element.name!r} is waited for, but never set"


def _awaited(context: Context) -> set[am.OsEvent]:
    return _in_masks(item.event_mask for item in context.all(am.WaitEvent))


def _set(context: Context) -> set[am.OsEvent]:
    return _in_masks(item.event_mask for item in context.all(am.SetEvent))


def _in_masks(masks: Iterable[am.EventMask | None]) -> set[am.OsEvent]:
    return {event for mask in masks if mask is not None for event in mask.events}
