"""What processes and runnables do: the activities of their graphs."""

from __future__ import annotations

from functools import partial
from math import isfinite
from typing import Any, cast

from amalthea_uros.bridge.basics.codecs import (
    PLAIN,
    Codec,
    build_reason,
    enumeration,
    extract_reason,
    reference,
    references,
    same_names,
)
from amalthea_uros.bridge.basics.context import Building, Extracting
from amalthea_uros.bridge.basics.entries import ClassEntry, ClassTable
from amalthea_uros.bridge.basics.kinds import ObjectKind
from amalthea_uros.bridge.tables.conditions import CONDITION
from amalthea_uros.bridge.tables.distributions import TICKS
from amalthea_uros.bridge.tables.stimuli import COUNTER
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.perf import activities as perf

# Demand


def _build_demand(demand: perf.Demand, context: Building) -> am.Ticks:
    entries = []
    for name, ticks in demand.by_core_type:
        core_type: Any = context.find(ObjectKind.CORE_TYPE, name)
        entries.append(am.TicksEntry(key=core_type, value=TICKS.build(ticks, context)))
    return am.Ticks(default=TICKS.build_given(demand.ticks, context), extended=entries)


def _extract_demand(ticks: Any, context: Extracting, _element: Element) -> perf.Demand | None:
    by_core_type: list[tuple[str, Any]] = [
        (name, TICKS.extract_given(entry.value, context, ticks))
        for entry in ticks.extended
        if (name := _CORE_TYPE.extract(entry.key, context, ticks)) is not None
    ]
    default = TICKS.extract_given(ticks.default, context, ticks)
    values = [value for _, value in by_core_type]
    # A core type whose own value is unknown does not take the default.
    if None in values or (default is None and (ticks.default is not None or not values)):
        context.note("EXT004", "Ticks are incomplete: a value is missing", ticks)
        return None
    return perf.Demand(default, tuple(by_core_type))


_CORE_TYPE = reference(ObjectKind.CORE_TYPE)

#: Demand as Ticks; without a value on any core if something is missing.
DEMAND = Codec(_build_demand, lambda ticks, context, element: _extract_demand(ticks, context, element) or perf.Demand())


# Numbers that were measured


def _build_count(count: perf.Count | float, _context: Building) -> am.NumericStatistic:
    if isinstance(count, perf.Count):
        return am.MinAvgMaxStatistic(min=count.least, avg=float(count.mean), max=count.most)
    return am.SingleValueStatistic(value=float(count))


def _extract_count(statistic: am.NumericStatistic | None, context: Extracting, element: Element) -> perf.Count | float | None:
    match statistic:
        case am.MinAvgMaxStatistic(min=least, avg=mean, max=most) if (least, mean, most) != (None, None, None):
            return perf.Count(least=least or 0, mean=mean or 0.0, most=most or 0)
        case am.SingleValueStatistic(value=float(value)):
            return value
        case am.MinAvgMaxStatistic() | am.SingleValueStatistic():
            # Rather once than never.
            context.note("EXT004", f"the statistic of the {type(element).__name__} has no value and is ignored", element)
    return None


def _extract_accesses(statistic: am.LabelAccessStatistic, context: Extracting, element: Element) -> perf.Count | float | None:
    if statistic.cache_misses is not None:
        context.leave_out(statistic.cache_misses, "LabelAccessStatistic.cacheMisses")
    return _extract_count(statistic.value, context, element)


_ACCESSES = Codec(lambda count, context: am.LabelAccessStatistic(value=_build_count(count, context)), _extract_accesses)
_CALLS = Codec(
    lambda count, context: am.RunEntityCallStatistic(statistic=_build_count(count, context)),
    lambda value, context, element: _extract_count(value.statistic, context, element),
)

# Activities

_LABEL = reference(ObjectKind.DATA)
_ACCESSES_OF_LABELS = (am.LabelAccess, am.SenderReceiverCommunication)
#: What takes time, or may wait, so that it must not disappear if it is incomplete.
_TAKING_TIME = (
    *_ACCESSES_OF_LABELS,
    am.Ticks,
    am.ExecutionNeed,
    am.RunnableCall,
    am.ServerCall,
    am.SemaphoreAccess,
    am.WaitEvent,
    am.EnforcedMigration,
)
#: The name of the group that represents an incomplete access; the label follows after a blank.
_ACCESS = "access"


class _Activities(ClassTable):
    """All activities of an activity graph; those with another structure in AMALTHEA have functions of their own."""

    def build(self, item: Any, context: Building) -> Any:
        match item:
            case perf.Execute(demand=demand):
                return _build_demand(demand, context)
            case perf.ExecutionNeed(needs=needs):
                return am.ExecutionNeed(needs=[am.NeedEntry(key=key, value=TICKS.build(need, context)) for key, need in needs])
            case perf.ProbabilitySwitch(branches=branches):
                return am.ProbabilitySwitch(
                    entries=[
                        am.ProbabilitySwitchEntry(probability=branch.weight, items=ITEMS.build(branch.activities, context))
                        for branch in branches
                    ]
                )
            case perf.Switch():
                return _build_switch(item, context)
            case perf.SenderReceiverAccess():
                return _build_communication(item, context)
            case perf.ServerCall():
                return _build_server_call(item, context)
            case perf.Incomplete(reason=reason, is_access=is_access, label=label):
                name = (_ACCESS if is_access else "") + ("" if label is None else f" {label}")
                return am.Group(name=name or None, custom_properties=build_reason(reason))
        return super().build(item, context)

    def extract(self, element: Any, context: Extracting) -> Any:
        found = self._complete(element, context)
        if found is not None or not isinstance(element, _TAKING_TIME):
            return found
        return perf.Incomplete(
            reason=f"an incomplete {type(element).__name__}",
            is_access=isinstance(element, _ACCESSES_OF_LABELS),
            label=_LABEL.extract(element.data, context, element) if type(element) is am.LabelAccess else None,
            locate=partial(context.location, element),
        )

    def _complete(self, element: Any, context: Extracting) -> Any:
        """The activity; None, with a finding, if something is missing."""
        if type(element) is am.LabelAccess:  # as most activities
            return super().extract(element, context)
        match element:
            case am.Group() if (reason := extract_reason(element)) is not None:
                what, blank, label = (element.name or "").partition(" ")
                locate = partial(context.location, element)
                return perf.Incomplete(reason=reason, is_access=what == _ACCESS, label=label if blank else None, locate=locate)
            case am.Ticks():
                demand = _extract_demand(element, context, element)
                return None if demand is None else perf.Execute(demand=demand, locate=partial(context.location, element))
            case am.ExecutionNeed():
                needs: tuple[tuple[str, Any], ...] = tuple(
                    (entry.key or "", TICKS.extract_given(entry.value, context, element)) for entry in element.needs
                )
                if any(need is None for _, need in needs):
                    context.note("EXT004", "ExecutionNeed is incomplete: a value is missing", element)
                    return None
                return perf.ExecutionNeed(needs=needs, locate=partial(context.location, element))
            case am.ProbabilitySwitch():
                if not all(isfinite(entry.probability or 0.0) for entry in element.entries):
                    context.note("EXT004", "ProbabilitySwitch is incomplete: a probability is no number", element)
                    return None
                return perf.ProbabilitySwitch(
                    branches=tuple(
                        perf.Chance(weight=entry.probability or 0.0, activities=ITEMS.extract(entry.items, context, element))
                        for entry in element.entries
                    ),
                    locate=partial(context.location, element),
                )
            case am.SenderReceiverCommunication():
                return _extract_communication(element, context)
            case am.ServerCall():
                return _extract_server_call(element, context)
            case am.Switch() | am.ModeSwitch():
                return _extract_switch(element, context)
        return super().extract(element, context)


def _build_switch(switch: perf.Switch, context: Building) -> Element:
    # Until 1.2 there is the switch on modes only.
    prefix = "Switch" if context.is_at_least(2) else "ModeSwitch"
    switch_class, entry_class, default_class = (getattr(am, prefix + suffix) for suffix in ("", "Entry", "Default"))
    found = switch_class(
        entries=[
            entry_class(
                name=case.name or None,
                condition=CONDITION.build_given(case.condition, context),
                items=ITEMS.build(case.activities, context),
            )
            for case in switch.cases
        ]
    )
    if switch.default is not None:
        found.default_entry = default_class(items=ITEMS.build(switch.default, context))
    return cast(Element, found)


def _extract_switch(element: Any, context: Extracting) -> perf.Switch:
    cases = tuple(
        perf.Case(
            name=entry.name or "",
            condition=CONDITION.extract_given(entry.condition, context, element),
            activities=ITEMS.extract(entry.items, context, element),
        )
        for entry in element.entries
    )
    default = ITEMS.extract_given(getattr(element.default_entry, "items", None), context, element)
    return perf.Switch(cases=cases, default=default, locate=partial(context.location, element))


def _build_communication(access: perf.SenderReceiverAccess, context: Building) -> Element:
    label: Any = _LABEL.build(access.label, context)
    buffered = access.buffered or None
    if access.kind is perf.AccessKind.READ:
        return am.SenderReceiverRead(label=label, buffered=buffered)
    return am.SenderReceiverWrite(label=label, buffered=buffered, notified_runnables=_RUNNABLES.build(access.notifies, context))


def _extract_communication(element: Any, context: Extracting) -> perf.SenderReceiverAccess | None:
    label = _LABEL.extract(element.label, context, element)
    if label is None:
        context.note("EXT004", f"{type(element).__name__} is incomplete: it has no label", element)
        return None
    is_write = isinstance(element, am.SenderReceiverWrite)
    return perf.SenderReceiverAccess(
        label=label,
        kind=perf.AccessKind.WRITE if is_write else perf.AccessKind.READ,
        buffered=bool(element.buffered),
        notifies=_RUNNABLES.extract(element.notified_runnables, context, element) if is_write else (),
        locate=partial(context.location, element),
    )


def _build_server_call(call: perf.ServerCall, context: Building) -> Element:
    server: Any = _RUNNABLE.build(call.runnable, context)
    match call.kind:
        case perf.ServerCallKind.SYNCHRONOUS:
            return am.SynchronousServerCall(
                server_runnable=server,
                waiting_behaviour=_WAITING_CODEC.build_given(call.waiting, context),
            )
        case perf.ServerCallKind.ASYNCHRONOUS:
            return am.AsynchronousServerCall(server_runnable=server, result_runnable=_RUNNABLE.build(call.result, context))
    blocking = am.BlockingType.NON_BLOCKING if not call.waits else _BLOCKING.get(call.waiting)
    return am.GetResultServerCall(server_runnable=server, blocking_type=blocking)


def _extract_server_call(element: Any, context: Extracting) -> perf.ServerCall | None:
    server = _RUNNABLE.extract(element.server_runnable, context, element)
    if server is None:
        context.note("EXT004", f"{type(element).__name__} is incomplete: it has no serverRunnable", element)
        return None
    result = element.result_runnable if isinstance(element, am.AsynchronousServerCall) else None
    return perf.ServerCall(
        runnable=server,
        kind=_SERVER_CALLS[type(element)],
        result=_RUNNABLE.extract(result, context, element),
        waits=getattr(element, "blocking_type", None) is not am.BlockingType.NON_BLOCKING,
        waiting=_waiting(element, context),
        locate=partial(context.location, element),
    )


def _waiting(element: Any, context: Extracting) -> perf.Waiting | None:
    """How the client of a call waits."""
    if isinstance(element, am.GetResultServerCall):
        return next((waiting for waiting, blocking in _BLOCKING.items() if blocking is element.blocking_type), None)
    stated = element.waiting_behaviour if isinstance(element, am.SynchronousServerCall) else None
    waiting: perf.Waiting | None = _WAITING_CODEC.extract_given(stated, context, element)
    return waiting


_LABEL, _RUNNABLE, _RUNNABLES = reference(ObjectKind.DATA), reference(ObjectKind.RUNNABLE), references(ObjectKind.RUNNABLE)
_WAITING_CODEC = same_names(perf.Waiting, am.WaitingBehaviour)
_BLOCKING: dict[perf.Waiting | None, am.BlockingType] = {
    perf.Waiting.ACTIVE: am.BlockingType.ACTIVE_WAIT,
    perf.Waiting.PASSIVE: am.BlockingType.PASSIVE_WAIT,
}
_SERVER_CALLS: dict[type[Element], perf.ServerCallKind] = {
    am.SynchronousServerCall: perf.ServerCallKind.SYNCHRONOUS,
    am.AsynchronousServerCall: perf.ServerCallKind.ASYNCHRONOUS,
    am.GetResultServerCall: perf.ServerCallKind.GET_RESULT,
}


#: The items of a group, a branch or a graph.
ITEMS = Codec(
    lambda items, context: [ACTIVITIES.build(item, context) for item in items],
    lambda values, context, _element: ACTIVITIES.extract_all(values, context),
)


def _extract_events(value: Any, context: Extracting, element: Element) -> tuple[str, ...]:
    names: tuple[str, ...] = references(ObjectKind.OS_EVENT).extract(value.events, context, element)
    return names


_EVENT_MASK = Codec(
    lambda names, context: am.EventMask(events=references(ObjectKind.OS_EVENT).build(names, context)), _extract_events
)
PROTECTIONS = {
    "NONE": "NO_PROTECTION",
    "AUTOMATIC": "AUTOMATIC_PROTECTION",
    "CUSTOM": "CUSTOM_PROTECTION",
    "BY_MODEL": "HANDLED_BY_MODEL_ELEMENTS",
}
_WAITING = ("waiting_behaviour", _WAITING_CODEC)
_MASK = ("event_mask", _EVENT_MASK)
_ITEMS = ("items", ITEMS)
_CHANNEL = ("data", reference(ObjectKind.DATA))
_MODE_LABEL = ("data", reference(ObjectKind.MODE_LABEL))
_ALL_OF_THEM = Codec(
    lambda value, _: am.WaitEventType.AND if value else am.WaitEventType.OR,
    lambda value, _context, _element: value is not am.WaitEventType.OR,
)

ACTIVITIES: ClassTable = _Activities(
    ClassEntry(
        perf.Call, am.RunnableCall, runnable=reference(ObjectKind.RUNNABLE), counter=COUNTER, times=("statistic", _CALLS)
    ),
    ClassEntry(
        perf.LabelAccess,
        am.LabelAccess,
        label=("data", _LABEL),
        kind=("access", same_names(perf.AccessKind, am.LabelAccessEnum)),
        communication=(
            "implementation",
            enumeration(
                {
                    perf.Communication.EXPLICIT: am.LabelAccessImplementation.EXPLICIT,
                    perf.Communication.IMPLICIT: am.LabelAccessImplementation.IMPLICIT,
                    perf.Communication.LET: am.LabelAccessImplementation.TIMED,
                }
            ),
        ),
        protection=("data_stability", same_names(perf.Protection, am.LabelAccessDataStability, **PROTECTIONS)),
        times=("statistic", _ACCESSES),
    ),
    ClassEntry(perf.Group, am.Group, name=PLAIN, activities=_ITEMS, ordered=PLAIN, interruptible=PLAIN),
    ClassEntry(perf.Loop, am.WhileLoop, activities=_ITEMS, condition=CONDITION),
    ClassEntry(
        perf.SemaphoreAccess,
        am.SemaphoreAccess,
        semaphore=reference(ObjectKind.SEMAPHORE),
        operation=("access", same_names(perf.SemaphoreOperation, am.SemaphoreAccessEnum)),
        waiting=_WAITING,
    ),
    ClassEntry(perf.Trigger, am.InterProcessTrigger, stimulus=reference(ObjectKind.STIMULUS), counter=COUNTER),
    ClassEntry(perf.RaiseEvent, am.CustomEventTrigger, event=reference(ObjectKind.EVENT)),
    ClassEntry(perf.SetEvent, am.SetEvent, events=_MASK, process=reference(ObjectKind.PROCESS), counter=COUNTER),
    ClassEntry(perf.ClearEvent, am.ClearEvent, events=_MASK, counter=COUNTER),
    ClassEntry(
        perf.WaitEvent, am.WaitEvent, events=_MASK, all_of_them=("mask_type", _ALL_OF_THEM), waiting=_WAITING, counter=COUNTER
    ),
    ClassEntry(perf.Send, am.ChannelSend, channel=_CHANNEL, elements=PLAIN),
    ClassEntry(
        perf.Receive,
        am.ChannelReceive,
        channel=_CHANNEL,
        elements=PLAIN,
        operation=("receive_operation", same_names(perf.ReceiveOperation, am.ReceiveOperation)),
        must_be_new="data_must_be_new",
        index="element_index",
        at_least="lower_bound",
    ),
    ClassEntry(
        perf.ModeAccess,
        am.ModeLabelAccess,
        label=_MODE_LABEL,
        operation=("access", same_names(perf.ModeOperation, am.ModeLabelAccessEnum)),
        value=PLAIN,
        step=PLAIN,
    ),
    ClassEntry(perf.SchedulePoint, am.SchedulePoint),
    ClassEntry(perf.Terminate, am.TerminateProcess, counter=COUNTER),
    ClassEntry(perf.Migrate, am.EnforcedMigration, scheduler=("resource_owner", reference(ObjectKind.SCHEDULER))),
)
