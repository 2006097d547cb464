"""Paths through a system along data and triggers, from which event chains can be made."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import networkx as nx

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
from amalthea_uros.perf.software import Call
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.links import Dataflow, NamesOf, reads, writes

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
    links : names of the data and triggers between each process and the next
    start, end : the runnables with which it starts and ends; None: the processes as a whole
    """

    processes: tuple[str, ...]
    links: tuple[tuple[str, ...], ...]
    start: str | None = None
    end: str | None = None

    def chain(self, name: str) -> tuple[EventChain, tuple[Event, ...]]:
        """The path as an event chain, and its events."""
        first, *others = self.processes
        events = [_end(first, self.start, is_start=True)]
        events += [_end(process, None, is_start=False) for process in others[:-1]]
        events.append(_end(self.processes[-1], self.end, is_start=False))
        segments = tuple(Segment(stimulus=one.name, response=then.name) for one, then in pairwise(events))
        items = Sequence(segments) if len(segments) > 1 else None
        return EventChain(name=name, stimulus=events[0].name, response=events[-1].name, items=items), tuple(events)


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
        for last, last_runnable in _ends(end, dataflow, reads):
            for nodes in _ways(graph, first, last):
                links = tuple(tuple(sorted(graph.edges[edge]["links"])) for edge in pairwise(nodes))
                found.append(Path(tuple(nodes), links, first_runnable, last_runnable))
    return sorted(dict.fromkeys(found), key=lambda path: (len(path.processes), path.processes))[:MAX_PATHS]


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
