"""Events and event chains of a project."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import Any, get_args

from amalthea_uros.errors import UnknownError
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.importing import Importing
from amalthea_uros.inchron_bridge.tables.chains import (
    BARRIER,
    CHAIN,
    LABEL_EVENTS,
    PROCESS_EVENTS,
    RUNNABLE_EVENTS,
    TRACE_EVENT,
)
from amalthea_uros.perf import events as perf

_PROCESS = {name: change for change, name in PROCESS_EVENTS.items()}
_RUNNABLE = {name: change for change, name in RUNNABLE_EVENTS.items()}
_LABEL = {name: change for change, name in LABEL_EVENTS.items()}
#: Most nodes of a chain; a graph that is damaged could have a circle.
_MOST_NODES = 10_000


class EventsReader:
    """Events by what they mean, and the chains of them.

    Attributes
    ----------
    events : all of them
    chains : names of the graphs that are understood
    """

    def __init__(self, context: Importing, model: ProjectObject) -> None:
        self.context = context
        self.model = model
        self.events: list[Any] = []
        self.names: dict[Any, str] = {}
        self.chains: dict[ProjectObject, str] = {}

    def read(self) -> perf.Events:
        """Read all."""
        for event in self.context.list_of(self.model, "events", get_args(perf.Event)):
            self.events.append(event)
            self.names.setdefault(_meaning(event), event.name)
        known = {event.name for event in self.events}
        result = []
        for item in self.model["eventChains"]:
            chain = self.chain(item)
            if chain is not None:
                self.chains[item] = chain.name
                result.append(chain)
        kept = self.context.list_of(self.model, "chains", (perf.EventChain,))
        result += [chain for chain in kept if _events_of(chain) <= known and chain.name not in self.chains.values()]
        return perf.Events(events=tuple(self.events), chains=tuple(result))

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
        meaning = _meaning(result)
        if meaning not in self.names:
            taken = {event.name for event in self.events}
            name, number = wish, 0
            while name in taken:
                name, number = f"{wish}_{number}", number + 1
            self.names[meaning] = name
            self.events.append(type(result)(**{**_fields(result), "name": name}))
        return self.names[meaning]

    def chain(self, item: ProjectObject) -> perf.EventChain | None:
        """The chain of a graph; None, with a finding, if it is not a line or joined by one barrier."""
        if item.kind != "EventGraph":
            self.context.leave_out(item)
            return None
        name = self.context.name("EventGraph", item)
        origin = self.context.location(item)
        kept = self.context.whole(item, CHAIN, (perf.EventChain,))
        known = {event.name for event in self.events}
        if kept is not None and _events_of(kept) <= known:
            return perf.EventChain(name=name, stimulus=kept.stimulus, response=kept.response, items=kept.items, origin=origin)
        try:
            branches, completed = _GraphWalk(item).branches()
            lines = [[self.step(node) for node in branch] for branch in branches]
        except UnknownError as error:
            self.context.note("INC006", f"the event chain {item.name!r} is left out: {error}", item)
            return None
        first, last = lines[0][0], lines[0][-1]
        if len(lines) == 1:
            return perf.EventChain(name=name, stimulus=first, response=last, items=_sequence(lines[0]), origin=origin)
        parts = tuple(perf.Segment(stimulus=first, response=last, items=_sequence(line)) for line in lines)
        items = perf.Parallel(items=parts, completed=completed or len(parts))
        return perf.EventChain(name=name, stimulus=first, response=last, items=items, origin=origin)

    def step(self, node: ProjectObject) -> str:
        """The event of a node."""
        first = node["first"]
        if first is None or not first["consumePredecessor"] or first["valueConstraint"]:
            raise UnknownError(f"the step {node.name!r} has a condition")
        return self.event(first["traceEvent"], first["process"], node.name)


class _GraphWalk:
    """The nodes of a graph from its initial to its terminal node."""

    def __init__(self, graph: ProjectObject) -> None:
        self.graph = graph
        self.after: dict[ProjectObject, list[ProjectObject]] = {}
        for node in graph["nodes"]:
            for before in node["predecessors"]:
                self.after.setdefault(before, []).append(node)

    def branches(self) -> tuple[list[list[ProjectObject]], int]:
        """The lines from the first to the last node, and how many of them have to complete."""
        graph = self.graph
        first, ends = graph["initialNode"], graph["terminalNodes"]
        if first is None or len(ends) != 1 or any(node.kind not in (TRACE_EVENT, BARRIER) for node in graph["nodes"]):
            raise UnknownError("it has several ends, or nodes that are neither trace events nor barriers")
        barriers = [node for node in graph["nodes"] if node.kind == BARRIER]
        starts = self.after.get(first, [])
        if first is ends[0] and not starts:
            return [[first]], 1
        lines = [self.line(first, start, ends[0]) for start in starts]
        if not lines or len(barriers) > 1 or (len(lines) > 1) != bool(barriers):
            raise UnknownError("it is neither a line nor branches that one barrier joins")
        if sum(len(line) - 2 for line in lines) + 2 != len(graph["nodes"]) - len(barriers):
            raise UnknownError("not all of its nodes are on a way to its end")
        return lines, barriers[0]["minItems"] if barriers else 1

    def line(self, first: ProjectObject, start: ProjectObject, end: ProjectObject) -> list[ProjectObject]:
        """The trace events from the first node along one branch."""
        result, node = [first], start
        for _ in range(_MOST_NODES):
            if node.kind == TRACE_EVENT:
                result.append(node)
            if node is end:
                return result
            following = self.after.get(node, [])
            if len(following) != 1:
                raise UnknownError("it branches within a branch, or ends early")
            node = following[0]
        raise UnknownError("it has a circle")


def _sequence(names: list[str]) -> perf.Sequence | None:
    if len(names) < 3:
        return None
    return perf.Sequence(tuple(perf.Segment(stimulus=a, response=b) for a, b in pairwise(names)))


def _meaning(event: Any) -> Any:
    return type(event), tuple((name, value) for name, value in _fields(event).items() if name not in ("name", "origin"))


def _fields(event: Any) -> Mapping[str, Any]:
    from dataclasses import fields

    return {field.name: getattr(event, field.name) for field in fields(event) if field.compare}


def _events_of(chain: Any) -> set[str]:
    result = {name for name in (chain.stimulus, chain.response) if name is not None}
    for item in chain.items.items if chain.items is not None else ():
        if isinstance(item, perf.Segment):
            result |= _events_of(item)
    return result
