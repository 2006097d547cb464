"""Events and event chains of a project."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from typing import Any, get_args

from amalthea_uros.diagnostics import Severity
from amalthea_uros.errors import UnknownError
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.importing import Importing
from amalthea_uros.inchron_bridge.basics.seals import is_sealed, objects_beside
from amalthea_uros.inchron_bridge.tables.chains import (
    CHAIN,
    LABEL_EVENTS,
    PROCESS_EVENTS,
    RUNNABLE_EVENTS,
    SYNCHRONIZED,
)
from amalthea_uros.inchron_bridge.tables.graphs_back import GraphRoute, Join, routes_of
from amalthea_uros.perf import events as perf

_PROCESS = {name: change for change, name in PROCESS_EVENTS.items()}
_RUNNABLE = {name: change for change, name in RUNNABLE_EVENTS.items()}
_LABEL = {name: change for change, name in LABEL_EVENTS.items()}


class EventsReader:
    """Events by what they mean, and the chains of them.

    Attributes
    ----------
    events : all of them
    result : the chains
    chains : names of the chains of each graph
    routes : the steps of each graph that is read, rather than what its comment keeps
    joined : graphs of which several are one chain, as it begins with several events
    """

    def __init__(self, context: Importing, model: ProjectObject) -> None:
        self.context = context
        self.model = model
        self.events: list[Any] = []
        self.names: dict[Any, str] = {}
        self.result: list[perf.EventChain] = []
        self.chains: dict[ProjectObject, tuple[str, ...]] = {}
        self.routes: dict[ProjectObject, tuple[GraphRoute, ...]] = {}
        self.joined: set[ProjectObject] = set()

    def read(self) -> None:
        """Read all."""
        for event in self.context.list_of(self.model, "events", get_args(perf.Event)):
            self.events.append(event)
            self.names.setdefault(replace(event, name=""), event.name)
        known = {event.name for event in self.events}
        for item in self.model["eventChains"]:
            if item in self.joined or (SYNCHRONIZED in self.context.noted(item) and is_sealed(item)):
                continue
            made = self.chains_of(item)
            self.chains[item] = tuple(chain.name for chain in made)
            self.result += made
        taken = {chain.name for chain in self.result}
        kept = self.context.list_of(self.model, "chains", (perf.EventChain,))
        self.result += [chain for chain in kept if _events_of(chain) <= known and chain.name not in taken]

    def events_and_chains(self) -> perf.Events:
        """All of them, with those that requirements needed."""
        return perf.Events(events=tuple(self.events), chains=tuple(self.result))

    def event(self, trace_event: ProjectObject | None, process: ProjectObject | None, wish: str) -> str:
        """The name of the event for a trace event.

        Raises
        ------
        UnknownError : it is not one of a process, a function or a variable.
        """
        holder = trace_event.owner if trace_event is not None else None
        where = self.context.name_of("Process", process) if process is not None else None
        result: Any = None
        if trace_event is not None and holder is not None and (process is None or where is not None):
            change = trace_event["type"]
            if holder.kind == "Process" and change in _PROCESS and where in (None, self.context.name_of("Process", holder)):
                result = perf.ProcessEvent(name=wish, process=self.context.name_of("Process", holder), change=_PROCESS[change])
            elif holder.kind == "Function" and change in _RUNNABLE:
                name = self.context.name_of("Function", holder)
                result = perf.RunnableEvent(name=wish, runnable=name, change=_RUNNABLE[change], process=where)
            elif holder.kind == "memory.DataObject" and change.lower() in _LABEL:
                name = self.context.name_of("DataObject", holder)
                result = perf.LabelEvent(name=wish, label=name, change=_LABEL[change.lower()], process=where)
        if result is None:
            raise UnknownError(f"the trace event {trace_event.name if trace_event is not None else ''!r} is not understood")
        return self.added(result)

    def added(self, event: Any) -> str:
        """The name of the event that means the same; if there is none, it is added under a free name."""
        meaning = replace(event, name="")
        if meaning not in self.names:
            taken = {each.name for each in self.events}
            name, number = event.name, 0
            while name in taken:
                name, number = f"{event.name}_{number}", number + 1
            self.names[meaning] = name
            self.events.append(replace(event, name=name))
        return self.names[meaning]

    def chains_of(self, item: ProjectObject) -> list[perf.EventChain]:
        """The chains of a graph, one for each route that its decisions choose; without events, with a finding, if it is not understood.

        A chain without events has no latency, so that limits of it stay unknown.
        """
        if item.kind != "EventGraph":
            self.context.leave_out(item)
        name = self.context.name("EventGraph", item)
        origin = self.context.location(item)
        kept = self.context.whole(item, CHAIN, (perf.EventChain,))
        known = {event.name for event in self.events}
        if kept is not None and _events_of(kept) <= known:
            several = objects_beside(item)
            self.joined |= set(several if len(several) > 1 else ())
            for each in several:
                with suppress(UnknownError):
                    self.routes[each] = tuple(routes_of(each).values())
            return [perf.EventChain(name=name, stimulus=kept.stimulus, response=kept.response, items=kept.items, origin=origin)]
        if item.kind != "EventGraph":
            return [perf.EventChain(name=name, origin=origin)]
        try:
            routes = routes_of(item)
            result = [self.chain(f"{name}_{choice}" if choice else name, route, origin) for choice, route in routes.items()]
        except UnknownError as error:
            self.context.note("INC006", f"the event chain {item.name!r} is left out: {error}", item)
            return [perf.EventChain(name=name, origin=origin)]
        if len(result) > 1:
            message = f"the event chain {item.name!r} has decisions; it is read as {', '.join(each.name for each in result)}"
            self.context.note("INC009", message, item, Severity.INFO)
        self.routes[item] = tuple(routes.values())
        return result

    def part(self, graph: ProjectObject, number: int, start: ProjectObject, end: ProjectObject) -> str:
        """The name of a chain that is a part of one of the routes of a graph, from one step to another.

        Raises
        ------
        UnknownError : the steps are within branches, or the other way round.
        """
        route, whole = self.routes[graph][number], self.chains[graph][number]
        if start not in route or end not in route or route.index(start) >= route.index(end):
            raise UnknownError("it is about steps within branches of its event chain, or not in their order")
        steps = route[route.index(start) : route.index(end) + 1]
        name = f"{whole}_{route.index(start)}_{route.index(end)}"
        if name not in {chain.name for chain in self.result}:
            self.result.append(self.chain(name, steps, self.context.location(graph)))
        return name

    def alone(self, graph: ProjectObject) -> tuple[str, GraphRoute]:
        """The name of a chain, and the steps, of one of the graphs of a chain that begins with several events.

        Raises
        ------
        UnknownError : it is not understood.
        """
        if len(self.routes.get(graph, ())) != 1:
            raise UnknownError("its event chain is not understood")
        name = self.context.name_of("EventGraph alone", graph)
        if name is None:
            name = self.context.name("EventGraph", graph, f"{graph.name}_alone")
            self.context.share("EventGraph alone", graph, name)
            self.result.append(self.chain(name, self.routes[graph][0], self.context.location(graph)))
        return name, self.routes[graph][0]

    def chain(self, name: str, route: GraphRoute, origin: Any) -> perf.EventChain:
        """The chain of a route."""
        first, *inside = self.named(route)
        if not inside:
            return perf.EventChain(name=name, stimulus=str(first), response=str(first), origin=origin)
        last = inside.pop()
        response = last if isinstance(last, str) else self.joint(f"{name}_end", last)
        return perf.EventChain(
            name=name, stimulus=str(first), response=response, items=_items(str(first), inside, response), origin=origin
        )

    def named(self, route: GraphRoute) -> list[Any]:
        """A route with the names of events."""
        return [
            Join(tuple(tuple(self.named(branch)) for branch in each.branches), each.needed)
            if isinstance(each, Join)
            else self.event(each["traceEvent"], each["process"], each.owner.name if each.owner is not None else "")
            for each in route
        ]

    def joint(self, wish: str, ends: Join) -> str:
        """The name of the set of events that all have to occur at the end of a chain."""
        return self.added(perf.EventSet(name=wish, events=tuple(str(branch[0]) for branch in ends.branches)))


def _items(before: str | None, parts: list[Any], after: str | None) -> perf.Sequence | perf.Parallel | None:
    """The parts between two events; None stands for an end without an event."""
    if not parts:
        return None
    if len(parts) == 1 and isinstance(parts[0], Join):
        branches = [
            perf.Segment(stimulus=before, response=after, items=_items(before, list(branch), after))
            for branch in parts[0].branches
        ]
        return perf.Parallel(items=tuple(branches), completed=parts[0].needed)
    segments: list[perf.Segment] = []
    start, pending = before, list[Any]()
    for part in (*parts, after):
        if isinstance(part, Join):
            if pending:
                segments.append(perf.Segment(stimulus=start, items=_items(start, pending, None)))
                start = None
            pending = [part]
            continue
        segments.append(perf.Segment(stimulus=start, response=part, items=_items(start, pending, part)))
        start, pending = part, []
    return perf.Sequence(tuple(segments))


def _events_of(chain: Any) -> set[str]:
    result = {name for name in (chain.stimulus, chain.response) if name is not None}
    for item in chain.items.items if chain.items is not None else ():
        if isinstance(item, perf.Segment):
            result |= _events_of(item)
    return result
