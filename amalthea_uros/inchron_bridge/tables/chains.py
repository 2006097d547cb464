"""Event chains as graphs of trace events."""

from __future__ import annotations

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.comments import keep_whole
from amalthea_uros.inchron_bridge.basics.exporting import Exporting
from amalthea_uros.perf import events as perf

#: The trace event of each transition; transitions without one cannot be observed there.
PROCESS_EVENTS = {
    perf.ProcessChange.ACTIVATE: "Activate",
    perf.ProcessChange.START: "Start",
    perf.ProcessChange.RESUME: "Restart",
    perf.ProcessChange.WAIT: "Block",
    perf.ProcessChange.RELEASE: "Release",
    perf.ProcessChange.TERMINATE: "Terminate",
}
RUNNABLE_EVENTS = {perf.RunnableChange.START: "Entry", perf.RunnableChange.TERMINATE: "Exit"}
LABEL_EVENTS = {perf.LabelChange.READ: "read", perf.LabelChange.WRITE: "write"}

TRACE_EVENT, BARRIER = "EventGraphTraceEvent", "EventGraphSynchronizationBarrier"
#: The key of a chain in the comment of its graph.
CHAIN = "chain"

#: Chains that contain each other would never end.
_DEPTH = 50


def trace_event(event: perf.Event | None, context: Exporting) -> tuple[ProjectObject, ProjectObject | None]:
    """The trace event for an event, and the process to which it is restricted.

    Raises
    ------
    UnknownError : there is none; the text says why.
    """
    result = None
    process: str | None = None
    name: str | None
    match event:
        case perf.ProcessEvent(process=name, change=change, core=None):
            result = context.trace_event("Process", name, PROCESS_EVENTS.get(change, "")) if change else None
        case perf.RunnableEvent(runnable=name, change=change, process=process, core=None):
            result = context.trace_event("Function", name, RUNNABLE_EVENTS.get(change, "")) if change else None
        case perf.LabelEvent(label=name, change=change, process=process):
            result = context.trace_event("DataObject", name, LABEL_EVENTS.get(change, "")) if change else None
        case perf.StimulusEvent(stimulus=name):
            users = [each for each in context.system.processes.values() if name in each.stimuli]
            if len(users) == 1 and len(users[0].stimuli) == 1:
                result = context.trace_event("Process", users[0].name, "Activate")
    if result is None:
        what = type(event).__name__ if event else "an event that is not stated"
        raise UnknownError(f"it contains {what}{f' {event.name!r}' if event else ''}, for which there is no trace event")
    return result, context.find("Process", process) if process else None


@dataclass(slots=True)
class _Ends:
    """The nodes that a part of a chain begins and ends with."""

    first: ProjectObject
    last: ProjectObject


def build_chains(context: Exporting) -> None:
    """Make the graphs; chains that cannot be one are reported."""
    for chain in context.system.events.chains:
        graph = ProjectObject("EventGraph", name=chain.name)
        try:
            builder = _ChainGraph(graph, context)
            ends = builder.build(chain, 0)
        except UnknownError as error:
            context.lost(chain, "an event chain", f"{error}; only amuros reads it, in a comment")
            continue
        graph["initialNode"], graph["terminalNodes"] = ends.first, [ends.last]
        if not builder.is_exact or not is_plain(chain):
            keep_whole(graph, CHAIN, chain)
        context.model.add("eventChains", context.register("EventGraph", chain.name, graph))


def is_plain(chain: perf.EventChain) -> bool:
    """Whether a graph alone says everything of a chain: a sequence of steps without gaps and names."""
    if chain.items is None:
        return True
    ends = [chain.stimulus]
    for item in chain.items.items:
        if not isinstance(item, perf.Segment) or item.items is not None or item.name or item.stimulus != ends[-1]:
            return False
        ends.append(item.response)
    return isinstance(chain.items, perf.Sequence) and len(ends) > 2 and ends[-1] == chain.response


class _ChainGraph:
    """One graph.

    Attributes
    ----------
    is_exact : whether the trace events say everything of the events
    """

    def __init__(self, graph: ProjectObject, context: Exporting) -> None:
        self.graph = graph
        self.context = context
        self.names: set[str] = set()
        self.is_exact = True

    def build(self, chain: perf.EventChain, depth: int) -> _Ends:
        """The whole, between its stimulus and its response."""
        inner = self.inner(chain.items, chain, depth)
        first, last = self.event(chain.stimulus), self.event(chain.response)
        self.link(first, inner, last)
        return _Ends(first, last)

    def link(self, first: ProjectObject, inner: list[list[ProjectObject]], last: ProjectObject) -> None:
        """Link branches, each a list of nodes in order, between two nodes; a barrier joins several branches."""
        target = last
        if len(inner) > 1:
            target = inner.pop()[0]
            last.add("predecessors", target)
        for branch in inner or [[]]:
            before = first
            for node in branch:
                node.add("predecessors", before)
                before = node
            target.add("predecessors", before)

    def inner(
        self, items: perf.Sequence | perf.Parallel | None, chain: perf.EventChain | perf.Segment, depth: int
    ) -> list[list[ProjectObject]]:
        """The branches between the ends; the last one of several is the barrier that joins them."""
        if depth > _DEPTH:
            raise UnknownError("it contains itself")
        if items is None or not items.items:
            return []
        parts = [self.part(item) for item in items.items]
        if isinstance(items, perf.Sequence):
            return [self.sequence(parts, depth)]
        if len(parts) == 1:
            return self.inner(parts[0].items, parts[0], depth + 1)
        branches = []
        for part in parts:
            if (part.stimulus, part.response) != (chain.stimulus, chain.response):
                raise UnknownError("a branch of it begins or ends with another event")
            nested = self.inner(part.items, part, depth + 1)
            if len(nested) > 1:
                raise UnknownError("a branch of it has branches")
            branches.append(nested[0] if nested else [])
        most = min(max(items.completed, 0), len(branches))
        barrier = ProjectObject(BARRIER, name=self.free(f"{self.graph.name}_sync"), minItems=most)
        self.graph.add("nodes", barrier)
        return [*branches, [barrier]]

    def sequence(self, parts: list[perf.EventChain | perf.Segment], depth: int) -> list[ProjectObject]:
        """The nodes of a sequence, from the stimulus of the second part on, as the importer of INCHRON reads it."""
        nodes: list[ProjectObject] = []
        for number, part in enumerate(parts):
            if number:
                nodes.append(self.event(part.stimulus))
                if parts[number - 1].response != part.stimulus:
                    self.context.changed(self.graph, "a sequence with a gap", "with the stimulus of each part only")
            nested = self.inner(part.items, part, depth + 1)
            if len(nested) > 1:
                raise UnknownError("a part of it has branches")
            nodes += nested[0] if nested else []
        return nodes

    def part(self, item: perf.ChainItem) -> perf.EventChain | perf.Segment:
        """A part of the chain, wherever it is described."""
        if isinstance(item, perf.Segment):
            return item
        result = self.context.system.chains.get(item.chain)
        if result is None:
            raise UnknownError(f"it contains the undefined chain {item.chain!r}")
        return result

    def event(self, name: str | None) -> ProjectObject:
        """A node for an event; for a set of events, refused, as it has several nodes."""
        event = self.context.system.events_by_name.get(name or "")
        if isinstance(event, perf.EventSet) and len(event.events) == 1:
            event = self.context.system.events_by_name.get(event.events[0])
        if isinstance(event, perf.EventSet):
            raise UnknownError(f"it contains the set of events {event.name!r}")
        if event is None:
            raise UnknownError("one of its events is not stated")
        result, process = trace_event(event, self.context)
        if isinstance(event, perf.StimulusEvent) or (isinstance(event, perf.LabelEvent) and event.runnable is not None):
            self.is_exact = False
            self.context.lost(event, "what an event is restricted to, or a stimulus as an event,")
        node = ProjectObject(TRACE_EVENT, name=self.free(event.name))
        node["first"] = ProjectObject("ConditionalTraceEvent", traceEvent=result, process=process)
        return self.graph.add("nodes", node)

    def free(self, name: str) -> str:
        """A name that no node of the chain has."""
        own, number = name, 0
        while name in self.names:
            name, number = f"{own}_{number}", number + 1
        self.names.add(name)
        return name
