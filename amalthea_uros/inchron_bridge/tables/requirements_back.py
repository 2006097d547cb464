"""The requirements of a project as limits."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from amalthea_uros.errors import UnknownError
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.comments import is_ours
from amalthea_uros.inchron_bridge.basics.importing import Importing
from amalthea_uros.inchron_bridge.basics.seals import objects_beside
from amalthea_uros.inchron_bridge.basics.values import NO_LIMIT, time_of
from amalthea_uros.inchron_bridge.tables.chains_back import EventsReader
from amalthea_uros.inchron_bridge.tables.graphs_back import joined_steps
from amalthea_uros.inchron_bridge.tables.requirements import LIMIT, OF_PROCESS
from amalthea_uros.perf import constraints as perf
from amalthea_uros.perf import events as perf_events
from amalthea_uros.perf.constraints import DataGroup

_FIELDS: dict[type[Any], str] = {
    perf.LatencyConstraint: "constraints",
    perf.DelayConstraint: "constraints",
    perf.RepetitionConstraint: "constraints",
    perf.EventSynchronization: "constraints",
    perf.ChainSynchronization: "constraints",
    perf.DataAgeConstraint: "data_ages",
    perf.OrderConstraint: "orders",
    perf.Requirement: "requirements",
    DataGroup: "data_groups",
}
_GROUP = "requirement.GroupOfRequirements"
#: The times between two trace events of an object, of which the first is the last one before the second.
_BETWEEN = {
    ("Activate", "Terminate"): perf.TimeMetric.RESPONSE_TIME,
    ("Activate", "Start"): perf.TimeMetric.START_DELAY,
    ("Entry", "Exit"): perf.TimeMetric.RESPONSE_TIME,
}
_METRICS = {kind: metric for metric, kind in OF_PROCESS.items()}


def extract_constraints(context: Importing, model: ProjectObject, events: EventsReader) -> perf.Constraints:
    """All limits that are understood."""
    result: dict[str, list[Any]] = {field: [] for field in _FIELDS.values()}
    covered: set[ProjectObject] = set()
    for item in _stated(model["requirements"]):
        if item in covered:
            continue
        kept = context.whole(item, LIMIT, tuple(_FIELDS), origin=context.location(item))
        several = objects_beside(item) if kept is not None else []
        if len(several) > 1 and not all(each["eventChain"] in events.joined for each in several):
            kept = None  # The graphs are no longer one chain, so that each has a limit of its own.
        covered |= set(several if kept is not None else ())
        limits = [kept] if kept is not None else _limits(item, context, events)
        for limit in limits:
            result[_FIELDS[type(limit)]].append(limit)
    return perf.Constraints(**{field: tuple(limits) for field, limits in result.items()})


def _stated(items: list[ProjectObject]) -> Iterator[ProjectObject]:
    """The requirements, also those in groups."""
    waiting = list(reversed(items))
    while waiting:
        item = waiting.pop()
        if item.kind == _GROUP and item["requirements"]:
            waiting += reversed(item["requirements"])
        elif item.kind != _GROUP or is_ours(item):
            yield item


def _limits(item: ProjectObject, context: Importing, events: EventsReader) -> list[Any]:
    """The limits of a requirement; if it is not understood, one of which nobody can say whether it is met, with a finding."""
    if not item["evaluate"] and item.kind != _GROUP:
        return []
    try:
        return list(_understood(item, context, events))
    except UnknownError as error:
        kind = item.kind.rpartition(".")[2]
        context.note(
            "INC006", f"the requirement {item.name!r} ({kind}) is not understood, so that nothing meets it: {error}", item
        )
        origin = context.location(item)
        chain = perf_events.EventChain(name=context.name("EventGraph", item, f"{kind} {item.name}".rstrip()), origin=origin)
        events.result.append(chain)
        name = context.name("Constraint", item, item.name or kind)
        return [perf.LatencyConstraint(name=name, chain=chain.name, origin=origin)]


def _understood(item: ProjectObject, context: Importing, events: EventsReader) -> list[Any]:
    origin = context.location(item)
    match item.kind:
        case "requirement.EventChainTimingRequirement":
            lower, upper = _interval(item)
            return [
                perf.LatencyConstraint(
                    name=context.name("Constraint", item, f"{item.name}_{number + 1}" if number else None),
                    chain=chain,
                    kind=_kind(item),
                    minimum=lower or None,
                    maximum=upper,
                    origin=origin,
                )
                for number, chain in enumerate(_chains(item, events))
            ]
        case "requirement.PeriodicEventRequirement":
            lower, upper = _interval(item)
            event = events.event(item["event"], None, item.name or "event")
            name = context.name("Constraint", item)
            return [perf.RepetitionConstraint(name=name, event=event, lower=lower or None, upper=upper, origin=origin)]
        case kind if kind in _METRICS:
            process = context.name_of("Process", item["process"])
            if process is None:
                raise UnknownError("its process is not understood")
            lower, upper = _interval(item)
            bounds = [(lower or None, perf.Bound.LOWER), (upper, perf.Bound.UPPER)]
            return [
                perf.Requirement(
                    name=item.name,
                    process=process,
                    limit=perf.TimeLimit(metric=_METRICS[kind], value=value, bound=bound),
                    origin=origin,
                )
                for value, bound in bounds
                if value is not None
            ]
        case "requirement.EventTimingRequirement":
            return [_between(item, context)]
    raise UnknownError("there is no limit with that meaning")


def _between(item: ProjectObject, context: Importing) -> perf.Requirement:
    """A limit of a time within a job; where jobs overlap, the project measures from a later start, so that this is no less strict."""
    start, end = item["start"], item["end"]
    holder = end.owner if end is not None and start is not None and end.owner is start.owner else None
    metric = _BETWEEN.get((start["type"], end["type"])) if holder is not None else None
    lower, upper = _interval(item)
    if holder is None or metric is None or lower or upper is None or item["trigger"] not in (None, end):
        raise UnknownError("it is not about the longest time within a job")
    process, runnable = (context.name_of(kind, holder) for kind in ("Process", "Function"))
    if process is None and runnable is None:
        raise UnknownError("its process is not understood")
    limit = perf.TimeLimit(metric=metric, value=upper)
    return perf.Requirement(name=item.name, process=process, runnable=runnable, limit=limit, origin=context.location(item))


def _interval(item: ProjectObject) -> tuple[int | None, int | None]:
    if item["successIfOutsideOfInterval"]:
        raise UnknownError("it demands a time outside an interval")
    interval = item["interval"]
    if not interval["upperLimitIncluded"] or not interval["lowerLimitIncluded"]:
        raise UnknownError("its interval does not include its ends")
    lower, upper = time_of(interval["lowerLimit"]), time_of(interval["upperLimit"])
    if lower is None or upper is None:
        raise UnknownError("its interval cannot be converted")
    return lower, None if upper >= NO_LIMIT else upper


def _chains(item: ProjectObject, events: EventsReader) -> list[str]:
    """The chains that a requirement is about: those of its graph, or a part of each; the graph may be one that is not understood."""
    graph, start, end = item["eventChain"], item["start"], item["end"]
    if graph not in events.chains and graph not in events.joined:
        raise UnknownError("its event chain is not understood")
    if item["instanceOffset"] or (item["orSemanticsStart"] and len(start) > 1) or (item["orSemanticsEnd"] and len(end) > 1):
        raise UnknownError("it compares several instances of its event chain, or is about one of several steps")
    if graph in events.joined:
        name, route = events.alone(graph)
        if start != [route[0]] or set(end) != set(joined_steps(route)):
            raise UnknownError("it is about a part of an event chain that begins with several events")
        return [name]
    chains = events.chains[graph]
    if graph not in events.routes:
        return list(chains)
    result = []
    for number, route in enumerate(events.routes[graph]):
        if start == [route[0]] and set(end) == set(joined_steps(route)):
            result.append(chains[number])
        elif len(start) == 1 and len(end) == 1:
            result.append(events.part(graph, number, start[0], end[0]))
        else:
            raise UnknownError("it is about a part of its event chain")
    return result


def _kind(item: ProjectObject) -> perf.LatencyKind:
    kinds = {"FirstFirst": perf.LatencyKind.REACTION, "FirstLast": perf.LatencyKind.AGE}
    if item["strategy"] not in kinds:
        raise UnknownError(f"its strategy {item['strategy']} is not understood")
    return kinds[item["strategy"]]
