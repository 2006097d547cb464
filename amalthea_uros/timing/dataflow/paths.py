"""Paths through a system along data and triggers, from which event chains can be made."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise, product

import networkx as nx

from amalthea_uros.perf.activities import Call
from amalthea_uros.perf.events import (
    Event,
    EventChain,
    Events,
    ProcessChange,
    ProcessEvent,
    RunnableChange,
    RunnableEvent,
    Segment,
    Sequence,
)
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.links import Dataflow, LinkKind, NamesOf, reads, writes
from amalthea_uros.timing.dataflow.routes import is_linked

#: More paths, or longer ones, are not listed.
MAX_PATHS = 100
MAX_PROCESSES = 12


class UnknownEndError(Exception):
    """A path cannot start or end at a name, because it is undefined."""


@dataclass(frozen=True, slots=True)
class Path:
    """A way through processes.

    Attributes
    ----------
    processes : contains a process twice in a row if it sends a message to itself
    links : names of the data and triggers between each process and the next
    events : from the start of the first process or runnable to the end of the last one
    """

    processes: tuple[str, ...]
    links: tuple[tuple[str, ...], ...]
    events: tuple[Event, ...]

    def chain(self, name: str) -> tuple[EventChain, tuple[Event, ...]]:
        """The path as an event chain, and its events."""
        segments = tuple(Segment(stimulus=one.name, response=then.name) for one, then in pairwise(self.events))
        items = Sequence(segments) if len(segments) > 1 else None
        return EventChain(name=name, stimulus=self.events[0].name, response=self.events[-1].name, items=items), self.events


def _end(process: str, runnable: str | None, is_start: bool) -> Event:
    if runnable is None:
        change = ProcessChange.START if is_start else ProcessChange.TERMINATE
        return ProcessEvent(name=f"{process}_{change}", process=process, change=change)
    edge = RunnableChange.START if is_start else RunnableChange.TERMINATE
    return RunnableEvent(name=f"{process}_{runnable}_{edge}", runnable=runnable, change=edge, process=process)


def paths(system: System, start: str, end: str) -> list[Path]:
    """The ways from one process, runnable or label to another one, the shortest first.

    Raises
    ------
    UnknownEndError : there is no process, runnable or label of a name.
    UnresolvedError : a process executes too many activities to be followed.
    """
    dataflow = Dataflow(system)
    graph = _graph(dataflow)
    found = []
    for first, first_runnable in _ends(start, dataflow, writes):
        begin = _end(first, first_runnable, is_start=True)
        returning = list(_returning(first, first_runnable, dataflow))
        for last, last_runnable in _ends(end, dataflow, reads):
            finish = _end(last, last_runnable, is_start=False)
            for nodes in _ways(graph, first, last):
                links = tuple(tuple(sorted(graph.edges[edge]["links"])) for edge in pairwise(nodes))
                rest = (*(_end(process, None, is_start=False) for process in nodes[1:-1]), finish)
                if events := _connected(begin, rest, dataflow):
                    found.append(Path(tuple(nodes), links, (begin, *events)))
                for channel, taken_by in returning:
                    taken = _end(first, taken_by, is_start=False)
                    if events := _connected(taken, rest, dataflow):
                        found.append(Path((first, *nodes), ((channel,), *links), (begin, taken, *events)))
    return sorted(dict.fromkeys(found), key=lambda path: (len(path.processes), path.processes))[:MAX_PATHS]


def _returning(process: str, runnable: str | None, dataflow: Dataflow) -> Iterator[tuple[str, str]]:
    """The topics by which a runnable sends messages to its own process, with the runnables that take them."""
    if runnable is None:
        return
    here = dataflow.events.positions(process)
    sent = {name for position in here if position.runnable == runnable for name in writes(position) if dataflow.is_topic(name)}
    for position in here:
        if position.runnable is not None:
            yield from ((name, position.runnable) for name in reads(position) if name in sent)


def _connected(first: Event, rest: tuple[Event, ...], dataflow: Dataflow) -> tuple[Event, ...]:
    """The events after the first one; none if its runnable passes nothing on to them, directly or by the rest of its job."""
    if is_linked(first, rest[0], dataflow):
        return rest
    (process,) = {occurrence.process.name for occurrence in dataflow.events.of(first)}
    job_end = _end(process, None, is_start=False)
    if len(rest) == 1 and dataflow.events.of(rest[0])[0].process.name == process:
        return ()
    passed_on = (dataflow.data(one, then) for one, then in product(dataflow.events.of(first), dataflow.events.of(job_end)))
    return (job_end, *rest) if any(link is not None and link.kind is LinkKind.DATA for link in passed_on) else ()


def _ways(graph: nx.DiGraph, first: str, last: str) -> Iterator[list[str]]:
    if first == last:
        yield [first]
        return
    for number, nodes in enumerate(nx.all_simple_paths(graph, first, last, cutoff=MAX_PROCESSES)):
        if number == MAX_PATHS:
            return
        yield nodes


def _ends(name: str, dataflow: Dataflow, accesses: NamesOf) -> list[tuple[str, str | None]]:
    """The processes of a name, those that call a runnable, or those that access a label."""
    system = dataflow.system
    if name in system.processes:
        return [(name, None)]
    everywhere = dataflow.events.all_positions()
    if name in system.runnables:
        return [(p.process.name, name) for p in everywhere if isinstance(p.activity, Call) and p.activity.runnable == name]
    if name in system.labels:
        return list(dict.fromkeys((p.process.name, None) for p in everywhere if name in accesses(p)))
    raise UnknownEndError(f"there is no process, runnable or label {name!r}")


def _graph(dataflow: Dataflow) -> nx.DiGraph:
    """The graph of processes and their links."""
    graph: nx.DiGraph = nx.DiGraph()
    graph.add_nodes_from(dataflow.system.processes)
    for process, name, target in dataflow.direct():
        if not graph.has_edge(process, target):
            graph.add_edge(process, target, links=set())
        graph.edges[process, target]["links"].add(name)
    return graph


def with_chains(system: System, found: list[Path]) -> System:
    """The system with these paths as its chains, named by their numbers."""
    events: dict[str, Event] = dict(system.events_by_name)
    chains = []
    for number, path in enumerate(found, start=1):
        chain, own = path.chain(str(number))
        chains.append(chain)
        events.update((event.name, event) for event in own)
    return replace(system, events=Events(events=tuple(events.values()), chains=tuple(chains)))
