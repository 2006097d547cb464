"""Event chains as graphs of trace events."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from amalthea_uros.errors import UnknownError
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.comments import keep_whole, note
from amalthea_uros.inchron_bridge.basics.exporting import Exporting
from amalthea_uros.perf import events as perf
from amalthea_uros.perf.constraints import ChainEnd, ChainSynchronization
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.chains import Fork, Unfolded, unfold
from amalthea_uros.timing.dataflow.untyped_events import is_untyped, readings

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
#: The key in the comment of a graph that only serves a limit, whose comment says what is meant.
SYNCHRONIZED = "synchronized"
#: The key in the comment of a graph, or of a limit of it, that belongs to the ones before it: they stand for one chain together.
BESIDE = "beside"


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


def build_chains(context: Exporting) -> None:
    """Make the graphs; chains that cannot be one are reported."""
    for chain in context.system.events.chains:
        try:
            events, left_out = unfold(chain, context.system)
            readings = [(path, typed) for path in ways_in(events) for typed in _typed_events(path, context.system)]
            builders = [
                _ChainGraph(f"{chain.name}_{number + 1}" if number else chain.name, context, typed)
                for number, (_, typed) in enumerate(readings)
            ]
            for builder, (path, _) in zip(builders, readings, strict=True):
                builder.build(path)
        except UnknownError as error:
            context.lost(chain, "an event chain", f"{error}; only amuros reads it, in a comment")
            continue
        if left_out:
            context.changed(chain, "a part with other ends than its chain", "with those of the chain")
        graphs = [builder.graph for builder in builders]
        if not all(builder.is_exact for builder in builders) or events != plain_events(chain):
            keep_whole(graphs[0], CHAIN, chain)
        if len(graphs) > 1:
            what = "that has events without a type" if readings[0][1] else "that begins with several events"
            context.changed(chain, f"an event chain {what}", "as one graph for each of them")
            join_items(graphs)
        context.graphs[chain.name] = graphs
        context.register("EventGraph", chain.name, graphs[0])
        for graph in graphs:
            context.model.add("eventChains", graph)


def join_items(items: list[ProjectObject]) -> None:
    """Note in the comment of the first of some objects in a row that they belong together."""
    note(items[0], span=len(items))
    for item in items[1:]:
        note(item, **{BESIDE: items[0].name})


def ways_in(events: Unfolded) -> list[Unfolded]:
    """A chain for each event that it begins with, as a graph begins with one; it is complete when all of these are.

    Raises
    ------
    UnknownError : one of several events is enough to begin.
    """
    first, *rest = events
    if isinstance(first, str):
        return [events]
    if first.needed < len(first.branches):
        raise UnknownError("it begins with one of several events, and a graph begins with one")
    # A branch without events begins with what follows.
    return [path for branch in dict.fromkeys(first.branches) for path in ways_in((*branch, *rest))]


def _typed_events(path: Unfolded, system: System) -> list[dict[str, perf.Event]]:
    """The events of a path that have no type with each of those that they may have, as the analysis reads them.

    Raises
    ------
    UnknownError : they are in branches, or stand twice.
    """
    events = [system.events_by_name[each] for each in path if isinstance(each, str)]
    if not any(map(is_untyped, events)):
        return [{}]
    names = [event.name for event in events]
    if len(set(names)) < len(path):
        raise UnknownError("it contains events without a type beside branches, or twice")
    return [dict(zip(names, reading, strict=True)) for reading in readings(events)]


def plain_events(chain: perf.EventChain) -> tuple[str | None, ...]:
    """The events of a chain of which a graph alone says everything: a sequence of steps without gaps and names; else nothing."""
    if chain.items is None:
        return (chain.stimulus, chain.response)
    ends = [chain.stimulus]
    for item in chain.items.items:
        if not isinstance(item, perf.Segment) or item.items is not None or item.name or item.stimulus != ends[-1]:
            return ()
        ends.append(item.response)
    is_line = isinstance(chain.items, perf.Sequence) and len(ends) > 2 and ends[-1] == chain.response
    return tuple(ends) if is_line else ()


class _ChainGraph:
    """One graph.

    Attributes
    ----------
    typed : events with other types than their own
    is_exact : whether the trace events say everything of the events
    """

    def __init__(self, name: str, context: Exporting, typed: Mapping[str, perf.Event] = MappingProxyType({})) -> None:
        self.graph = ProjectObject("EventGraph", name=name)
        self.context = context
        self.typed = typed
        self.names: set[str] = set()
        self.inner: list[tuple[ProjectObject, str]] = []
        self.is_exact = not typed

    def build(self, events: Unfolded) -> None:
        """Make the nodes: first those inside, then the stimulus, then the response, as the importer of INCHRON orders them."""
        first, *inside = events
        if isinstance(first, Fork) or not inside:
            raise UnknownError("it begins with several events, or ends with the one that it begins with")
        start, last = self.event(first), inside.pop()
        before = self.line(tuple(inside), start)
        ends = {name: link(self.event(name), self.line(branch, before)) for branch, name in joint_ends(last)}
        for node, name in (*self.inner, (start, first), *((node, name) for name, node in ends.items())):
            node["name"] = self.free(name)
            self.graph.add("nodes", node)
        self.graph["initialNode"], self.graph["terminalNodes"] = start, ends.values()

    def line(self, events: Unfolded, before: ProjectObject) -> ProjectObject:
        """Make the nodes after another one; returns the last one."""
        for event in events:
            if isinstance(event, Fork):
                before = self.fork(event, before)
                continue
            node = self.event(event)
            self.inner.append((node, event))
            before = link(node, before)
        return before

    def fork(self, fork: Fork, before: ProjectObject) -> ProjectObject:
        """The branches, and the barrier that joins them; 0 stands for all, which is what a set of events needs."""
        ends = [self.line(branch, before) for branch in fork.branches]
        # Branches without steps of their own are complete at once: one link stands for all of them.
        direct = max(sum(end is before for end in ends) - 1, 0)
        needed = 0 if fork.name else max(fork.needed - direct, 1)
        barrier = ProjectObject(BARRIER, minItems=needed)
        for end in dict.fromkeys(ends):
            link(barrier, end)
        self.inner.append((barrier, f"{fork.name or fork.part or self.graph.name}_sync"))
        return barrier

    def event(self, name: str) -> ProjectObject:
        """A node for an event, without its name."""
        event = self.typed.get(name) or self.context.system.events_by_name[name]
        result, process = trace_event(event, self.context)
        if isinstance(event, perf.StimulusEvent) or (isinstance(event, perf.LabelEvent) and event.runnable is not None):
            self.is_exact = False
            self.context.lost(event, "what an event is restricted to, or a stimulus as an event,")
        node = ProjectObject(TRACE_EVENT)
        node["first"] = ProjectObject("ConditionalTraceEvent", traceEvent=result, process=process)
        return node

    def free(self, name: str) -> str:
        """A name that no node of the chain has."""
        own, number = name, 0
        while name in self.names:
            name, number = f"{own}_{number}", number + 1
        self.names.add(name)
        return name


def joint_ends(last: str | Fork) -> list[tuple[Unfolded, str]]:
    """The events that have to occur at the end, each after what is in its branch: a requirement may be about several steps."""
    if isinstance(last, str):
        return [((), last)]
    ends = [(branch[:-1], branch[-1]) for branch in last.branches if branch and isinstance(branch[-1], str)]
    result = [(before, str(name)) for before, name in ends]
    if last.needed < len(last.branches) or len({name for _, name in result}) < len(last.branches):
        raise UnknownError("it ends with one of several events")
    return result


def build_synchronized(limit: ChainSynchronization, context: Exporting) -> ProjectObject:
    """A graph of chains that begin with the same event, each of which ends with a step of its own.

    Raises
    ------
    UnknownError : the chains have no such graph.
    """
    chains = [context.system.chains.get(name) for name in limit.chains]
    lines = [unfold(chain, context.system)[0] for chain in chains if chain is not None]
    if limit.end is not ChainEnd.RESPONSE or len({line[0] for line in lines}) != 1 or None in chains:
        raise UnknownError("its chains do not begin with the same event and end together")
    builder = _ChainGraph(f"{limit.name}_chains", context)
    builder.build((lines[0][0], Fork(tuple(line[1:] for line in lines), len(lines))))
    graph = builder.graph
    note(graph, **{SYNCHRONIZED: True})
    context.model.add("eventChains", graph)
    return graph


def link(node: ProjectObject, before: ProjectObject) -> ProjectObject:
    """Let a node follow another one; returns the node."""
    node.add("predecessors", before)
    return node
