"""Chains that nobody has modelled: the ways along which data and triggers take an effect through a system."""

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
from amalthea_uros.perf.software import AccessKind, Call, LabelAccess, Receive, Send, Trigger
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.links import Resolver
from amalthea_uros.timing.dataflow.positions import Place

#: More ways, or longer ones, are not listed.
MOST_PATHS = 100
LONGEST = 12


class UnknownEndError(Exception):
    """There is nothing of a name at which a path could start or end."""


@dataclass(frozen=True, slots=True)
class Path:
    """A way through processes.

    Attributes
    ----------
    carriers : what takes the effect from each process to the next
    start, end : the runnables with which it starts and ends; None: the processes as a whole
    """

    processes: tuple[str, ...]
    carriers: tuple[tuple[str, ...], ...]
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
    moment = RunnableChange.START if is_start else RunnableChange.TERMINATE
    return RunnableEvent(name=f"{process}_{runnable}_{moment}", runnable=runnable, change=moment, process=process)


def paths(system: System, start: str, end: str) -> list[Path]:
    """The ways from one process, runnable or label to another one, the shortest first.

    Raises
    ------
    UnknownEndError : there is no process, runnable or label of a name.
    """
    resolver = Resolver(system)
    graph = _graph(system, resolver)
    found = []
    for first, first_runnable in _ends(start, system, resolver, AccessKind.WRITE):
        for last, last_runnable in _ends(end, system, resolver, AccessKind.READ):
            for nodes in _ways(graph, first, last):
                carriers = tuple(tuple(sorted(graph.edges[edge]["carriers"])) for edge in pairwise(nodes))
                found.append(Path(tuple(nodes), carriers, first_runnable, last_runnable))
    return sorted(dict.fromkeys(found), key=lambda path: (len(path.processes), path.processes))[:MOST_PATHS]


def _ways(graph: nx.DiGraph, first: str, last: str) -> Iterator[list[str]]:
    if first == last:
        yield [first]
        return
    for number, nodes in enumerate(nx.all_simple_paths(graph, first, last, cutoff=LONGEST)):
        if number == MOST_PATHS:
            return
        yield nodes


def _ends(name: str, system: System, resolver: Resolver, kind: AccessKind) -> list[tuple[str, str | None]]:
    """The processes of a name, those that call a runnable, or those that access a label."""
    if name in system.processes:
        return [(name, None)]
    everything = [place for process in system.processes for place in resolver.spots.places(process)]
    if name in system.runnables:
        return [(p.process.name, name) for p in everything if isinstance(p.activity, Call) and p.activity.runnable == name]
    if name in system.labels:
        return list(dict.fromkeys((p.process.name, None) for p in everything if _accesses(p, kind) == name))
    raise UnknownEndError(f"there is no process, runnable or label {name!r}")


def _accesses(place: Place, kind: AccessKind) -> str | None:
    match place.activity:
        case LabelAccess(label=name, kind=found) if found is kind:
            return name
        case Send(channel=name) if kind is AccessKind.WRITE:
            return name
        case Receive(channel=name) if kind is AccessKind.READ:
            return name
    return None


def _graph(system: System, resolver: Resolver) -> nx.DiGraph:
    """Processes, and what takes an effect from one to another."""
    graph: nx.DiGraph = nx.DiGraph()
    graph.add_nodes_from(system.processes)
    readers: dict[str, list[str]] = {}
    activated: dict[str, list[str]] = {}
    for name, process in system.processes.items():
        for stimulus in process.stimuli:
            activated.setdefault(stimulus, []).append(name)
        for place in resolver.spots.places(name):
            if (read := _accesses(place, AccessKind.READ)) is not None:
                readers.setdefault(read, []).append(name)
    for name in system.processes:
        for place in resolver.spots.places(name):
            written = _accesses(place, AccessKind.WRITE)
            targets = readers.get(written, []) if written is not None else []
            carrier = written or ""
            if isinstance(place.activity, Trigger):
                carrier, targets = place.activity.stimulus, activated.get(place.activity.stimulus, [])
            for target in targets:
                if target != name:
                    if not graph.has_edge(name, target):
                        graph.add_edge(name, target, carriers=set())
                    graph.edges[name, target]["carriers"].add(carrier)
    return graph


def with_chains(system: System, found: list[Path]) -> System:
    """A system of which the chains are these paths, by their numbers."""
    events: dict[str, Event] = dict(system.events_by_name)
    chains = []
    for number, path in enumerate(found, start=1):
        chain, own = path.chain(str(number))
        chains.append(chain)
        events.update((event.name, event) for event in own)
    return replace(system, events=Events(events=tuple(events.values()), chains=tuple(chains)))
