"""Activities of the call graphs of a project."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from math import ceil, floor
from typing import Any, get_args

from amalthea_uros.errors import UnknownError
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.comments import noted, whole
from amalthea_uros.inchron_bridge.basics.importing import Importing
from amalthea_uros.inchron_bridge.basics.seals import require_sealed
from amalthea_uros.inchron_bridge.basics.values import time_of
from amalthea_uros.inchron_bridge.tables.activities import ACCESSES, ACTIVITY, GROUP, MODIFICATIONS, ROWS, SERVER_CALLS
from amalthea_uros.inchron_bridge.tables.conditions import extract_condition
from amalthea_uros.inchron_bridge.tables.distributions import extract
from amalthea_uros.perf import activities as perf
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.units import SECOND

_GENERATED = re.compile(r"CallSequence_\d+")
_ROWS = {row.kind: row for _, row in ROWS.values()}
_CALLS = {row.kind: (kind, row) for kind, (_, row) in SERVER_CALLS.items()}
_ACCESSES = {name: kind for kind, name in ACCESSES.items()}
_MODIFICATIONS = {name: operation for operation, name in MODIFICATIONS.items()}


def extract_graph(graph: ProjectObject | None, context: Importing) -> tuple[perf.Activity, ...]:
    """The activities of a call graph."""
    return () if graph is None else _entries(graph["graphEntries"], context)


def _entries(entries: list[ProjectObject], context: Importing) -> tuple[perf.Activity, ...]:
    result: list[perf.Activity] = []
    place = 0
    while place < len(entries):
        entry = entries[place]
        group = context.whole(entry, GROUP, (perf.Group,))
        if group is None:
            result += _entry(entry, context)
            place += 1
        else:
            result.append(replace(group, locate=context.located(entry)))
            place += context.noted(entry)["span"]
    return tuple(result)


def _entry(entry: ProjectObject, context: Importing) -> Iterator[perf.Activity]:
    locate = context.located(entry)
    match entry.kind:
        case "CallSequence":
            yield from _sequence(entry, context)
        case "Switch":
            cases = tuple(_case(each, context) for each in entry["entries"])
            default = entry["defaultEntry"]
            activities = None if default is None else _entries(default["graphEntries"], context)
            yield perf.Switch(cases=cases, default=activities, locate=locate)
        case "ProbabilitySwitch":
            chances = [
                perf.Chance(weight=each["probability"], activities=_entries(each["graphEntries"], context))
                for each in entry["entries"]
            ]
            yield perf.ProbabilitySwitch(branches=tuple(chances), locate=locate)
        case "WhileLoop":
            is_plain = not entry["negated"] and not entry["postConditionCheck"]
            condition = extract_condition(entry["condition"], context) if is_plain else None
            yield perf.Loop(activities=_entries(entry["graphEntries"], context), condition=condition, locate=locate)
        case _:
            yield _unknown(entry, context)


def _case(entry: ProjectObject, context: Importing) -> perf.Case:
    condition = None if entry["negated"] else extract_condition(entry["condition"], context)
    name = context.noted(entry).get("name", "")
    return perf.Case(
        activities=_entries(entry["graphEntries"], context), condition=condition, name=name if isinstance(name, str) else ""
    )


def _sequence(entry: ProjectObject, context: Importing) -> Iterator[perf.Activity]:
    calls = list(entry["calls"])
    name = "" if _GENERATED.fullmatch(entry.name) else entry.name
    is_suspending = len(calls) > 1 and (calls[0].kind, calls[-1].kind) == ("SuspendAllInterrupts", "ResumeAllInterrupts")
    if is_suspending:
        calls = calls[1:-1]
    activities = tuple(activity for call in calls for activity in _items(call, context))
    if is_suspending or name:
        yield perf.Group(activities=activities, name=name, interruptible=not is_suspending, locate=context.located(entry))
    else:
        yield from activities


def _items(item: ProjectObject, context: Importing) -> Iterator[perf.Activity]:
    """The activities that an item of a call sequence stands for, with its counter."""
    try:
        content = noted(item)
        if ACTIVITY in content:
            require_sealed(item)
            yield replace(whole(content[ACTIVITY], get_args(perf.Activity)), locate=context.located(item))
            return
        counter = _counter(item, content)
    except UnknownError as error:
        context.comment_unused(item, error)
        counter = _counter(item, {})
    for activity in _plain(item, context):
        if counter is None:
            yield activity
        elif hasattr(activity, "counter"):
            yield replace(activity, counter=counter)  # type: ignore[arg-type]
        else:
            yield _unknown(item, context, "it takes effect only every few times")


def _counter(item: ProjectObject, content: dict[str, Any]) -> Counter | None:
    if "counter" in content:
        require_sealed(item)
        return whole(content["counter"], [Counter])
    period, offset = item["period"], item["offset"]
    return None if (period, offset) == (1, 0) else Counter(prescaler=period, offset=offset)


def _unknown(item: ProjectObject, context: Importing, reason: str = "") -> perf.Incomplete:
    """Something that may take any time."""
    context.leave_out(item)
    reason = reason or "its class is not understood"
    return perf.Incomplete(reason=f"{item.kind} {item.name!r} of the project: {reason}", locate=context.located(item))


def _plain(item: ProjectObject, context: Importing) -> Iterator[perf.Activity]:
    locate = context.located(item)
    match item.kind:
        case "ResourceConsumption":
            yield from _consumption(item, context)
        case "FunctionCall" if item["concurrent"] or item["guards"]:
            yield _unknown(item, context, "it is concurrent or guarded")
        case "ActivationItem" if item["delay"] is not None:
            yield _unknown(item, context, "it is delayed")
        case "WaitEvent" if item["timeout"] is not None or item["forReset"]:
            yield _unknown(item, context, "it has a timeout or waits for a reset")
        case "SetEvent" | "WaitEvent":
            yield _event(item, context)
        case "VariableReadAccess" | "VariableWriteAccess":
            yield _communication(item, context)
        case "ModeSwitchPoint" | "CounterModification":
            yield _mode(item, context)
        case kind if kind in _CALLS:
            call, row = _CALLS[kind]
            known: dict[str, Any] = {"kind": call, "locate": locate}
            if kind == "GetResultServerCall" and item["blockingType"] == "NonBlocking":
                known |= {"waits": False, "waiting": None}
            yield row.extract(item, context, **known) or _unknown(item, context, "it refers to nothing")
        case kind if kind in _ROWS:
            yield _ROWS[kind].extract(item, context, locate=locate) or _unknown(item, context, "it refers to nothing")
        case _:
            yield _unknown(item, context)


def _consumption(item: ProjectObject, context: Importing) -> Iterator[perf.Activity]:
    if item["useEntryFunction"]:
        yield _unknown(item, context, "a function of the source code says how long it takes")
        return
    for access in item["dataAccess"]:
        label = context.name_of("DataObject", access["dataObject"]) if access.kind == "memory.ExplicitDataAccess" else None
        if label is None:
            yield _unknown(item, context, "its data access is not understood")
        else:
            kept = context.fields(item, perf.LabelAccess, ("communication", "protection", "times"))
            kind = _ACCESSES[access["accessType"]]
            yield perf.LabelAccess(label=label, kind=kind, locate=context.located(item), **kept)
    distribution = item["timeDistribution"]
    if item["dataAccess"] and distribution["type"] == "Max" and not any(distribution[each]["value"] for each in ("min", "max")):
        return
    ticks = extract(distribution, lambda value: _ticks(value, context))
    if ticks is None:
        yield _unknown(item, context, "its time cannot be converted to ticks of a core")
    else:
        yield perf.Execute(demand=perf.Demand(ticks), locate=context.located(item))


def _ticks(value: ProjectObject, context: Importing) -> int | None:
    """Ticks; those of a time only if all cores have the same frequency, and rounded up, which is no bound from below."""
    if value["unit"] == "T":
        return int(value["value"])
    time = time_of(value)
    if time == 0:
        return 0
    if time is None or context.frequency is None:
        return None
    exact = Fraction(time) * context.frequency / SECOND
    return ceil(exact) if value.owner is None or value is not value.owner["min"] else floor(exact)


def _event(item: ProjectObject, context: Importing) -> perf.Activity:
    event = context.name_of("Event", item["event"])
    locate = context.located(item)
    if event is None:
        return _unknown(item, context, "it refers to nothing")
    if item.kind == "WaitEvent":
        return perf.WaitEvent(events=(event,), locate=locate, **context.fields(item, perf.WaitEvent, ("waiting",)))
    if item["reset"]:
        return perf.ClearEvent(events=(event,), locate=locate)
    return perf.SetEvent(events=(event,), locate=locate, **context.fields(item, perf.SetEvent, ("process",)))


def _communication(item: ProjectObject, context: Importing) -> perf.Activity:
    access = item["dataAccess"]
    label = context.name_of("DataObject", access["dataObject"]) if access is not None else None
    notified = (
        [context.name_of("Function", each) for each in item["notifiedFunctions"]] if item.kind == "VariableWriteAccess" else []
    )
    if label is None or item["connection"] is not None or None in notified:
        return _unknown(item, context, "it uses a data flow connection")
    return perf.SenderReceiverAccess(
        label=label,
        kind=_ACCESSES[access["accessType"]],
        notifies=tuple(name for name in notified if name is not None),
        locate=context.located(item),
        **context.fields(item, perf.SenderReceiverAccess, ("buffered",)),
    )


def _mode(item: ProjectObject, context: Importing) -> perf.Activity:
    locate = context.located(item)
    if item.kind == "ModeSwitchPoint":
        mode = item["mode"]
        label = context.name_of("ModeGroup", mode.owner) if mode is not None else None
        if label is not None:
            return perf.ModeAccess(label=label, operation=perf.ModeOperation.SET, value=mode.name, locate=locate)
    else:
        label, operation = context.name_of("Counter", item["counter"]), _MODIFICATIONS[item["type"]]
        if label is not None and operation is perf.ModeOperation.SET:
            return perf.ModeAccess(label=label, operation=operation, value=str(item["value"]), locate=locate)
        if label is not None:
            return perf.ModeAccess(label=label, operation=operation, step=item["value"], locate=locate)
    return _unknown(item, context, "it refers to nothing")
