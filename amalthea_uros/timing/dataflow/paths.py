"""Paths through a system along data and triggers, from which event chains can be made."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise, product

import networkx as nx

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.errors import InvalidArgumentError
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
)
from amalthea_uros.perf.events import Sequence as InSequence
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.links import Dataflow, LinkKind, NamesOf, reads, writes
from amalthea_uros.timing.dataflow.routes import is_linked

#: More paths, or longer ones, are not listed; between each two ends, no more than that are looked for.
MAX_PATHS = 100
MAX_PROCESSES = 12
#: More ways through processes are not examined.
MAX_WAYS = 10_000


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
        items = InSequence(segments) if len(segments) > 1 else None
        return EventChain(name=name, stimulus=self.events[0].name, response=self.events[-1].name, items=items), self.events


def _end(process: str, runnable: str | None, is_start: bool) -> Event:
    if runnable is None:
        change = ProcessChange.START if is_start else ProcessChange.TERMINATE
        return ProcessEvent(name=f"{process}_{change}", process=process, change=change)
    edge = RunnableChange.START if is_start else RunnableChange.TERMINATE
    return RunnableEvent(name=f"{process}_{runnable}_{edge}", runnable=runnable, change=edge, process=process)


@dataclass(frozen=True, slots=True)
class Paths:
    """Paths from one end to another, the shortest first.

    Attributes
    ----------
    are_all : whether there are no others of up to `MAX_PROCESSES` processes
    """

    found: tuple[Path, ...]
    are_all: bool


def paths(system: System, start: str, end: str) -> Paths:
    """The ways from one process, runnable or label to another one.

    Raises
    ------
    InvalidArgumentError : there is no process, runnable or label of a name.
    UnknownError : a process executes too many activities to be followed.
    """
    dataflow = Dataflow(system)
    graph = _graph(dataflow)
    found: dict[Path, None] = {}
    ways, are_all = 0, True
    for first, first_runnable in _ends(start, dataflow, writes):
        begin = _end(first, first_runnable, is_start=True)
        returning = list(_returning(first, first_runnable, dataflow))
        for last, last_runnable in _ends(end, dataflow, reads):
            finish = _end(last, last_runnable, is_start=False)
            for number, nodes in enumerate(_ways(graph, first, last)):
                if number == MAX_PATHS or ways == MAX_WAYS:
                    are_all = False
                    break
                ways += 1
                links = tuple(tuple(sorted(graph.edges[edge]["links"])) for edge in pairwise(nodes))
                rest = (*(_end(process, None, is_start=False) for process in nodes[1:-1]), finish)
                if events := _connected(begin, rest, dataflow):
                    found[Path(tuple(nodes), links, (begin, *events))] = None
                for channel, taken_by in returning:
                    taken = _end(first, taken_by, is_start=False)
                    if events := _connected(taken, rest, dataflow):
                        found[Path((first, *nodes), ((channel,), *links), (begin, taken, *events))] = None
    shortest_first = sorted(found, key=lambda path: (len(path.processes), path.processes))
    return Paths(tuple(shortest_first[:MAX_PATHS]), are_all and len(found) <= MAX_PATHS)


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
    ends = product(dataflow.events.of(first), dataflow.events.of(job_end))
    passed_on = (link for one, then in ends for link in dataflow.data(one, then))
    return (job_end, *rest) if any(link.kind is LinkKind.DATA for link in passed_on) else ()


def _ways(graph: nx.DiGraph, first: str, last: str) -> Iterator[list[str]]:
    """The ways from one process to another that pass no process twice.

    A way is continued only where the end can be reached without passing a process again, so that the time from each way to the next
    one is polynomial, also where most continuations lead nowhere (as in J. Y. Yen, "Finding the K shortest loopless paths in a
    network", Management Science 17(11), 1971).
    """
    way = [first]
    pending = [_continuations(graph, way, last)]
    if first == last:
        yield way
        return
    while pending:
        following = next(pending[-1], None)
        if following is None:
            pending.pop()
            way.pop()
        elif following == last:
            yield [*way, last]
        else:
            way.append(following)
            pending.append(_continuations(graph, way, last))


def _continuations(graph: nx.DiGraph, way: Sequence[str], last: str) -> Iterator[str]:
    """The processes after a way from which the end can be reached with no more than the allowed number of links."""
    links_left = MAX_PROCESSES - len(way)
    passed, reaching, outermost = set(way), {last}, [last]
    for _ in range(links_left):
        outermost = list(
            dict.fromkeys(p for name in outermost for p in graph.pred[name] if p not in passed and p not in reaching)
        )
        reaching.update(outermost)
    return (name for name in graph.succ[way[-1]] if name in reaching and name not in passed)


def _ends(name: str, dataflow: Dataflow, accesses: NamesOf) -> list[tuple[str, str | None]]:
    """The processes of a name, those that call a runnable, or those that access a label."""
    system = dataflow.system
    if name in system.processes:
        return [(name, None)]
    everywhere = dataflow.events.all_positions()
    if name in system.runnables:
        calling = (p.process.name for p in everywhere if isinstance(p.activity, Call) and p.activity.runnable == name)
        return [(process, name) for process in dict.fromkeys(calling)]
    if name in system.labels:
        return list(dict.fromkeys((p.process.name, None) for p in everywhere if name in accesses(p)))
    raise InvalidArgumentError(f"there is no process, runnable or label {name!r}")


def _graph(dataflow: Dataflow) -> nx.DiGraph:
    """The graph of processes and their links."""
    graph: nx.DiGraph = nx.DiGraph()
    graph.add_nodes_from(dataflow.system.processes)
    for link in dataflow.direct():
        if not graph.has_edge(link.source, link.target):
            graph.add_edge(link.source, link.target, links=set())
        graph.edges[link.source, link.target]["links"].add(link.name)
    return graph


def with_chains(system: System, found: Iterable[Path]) -> System:
    """The system with these paths as its chains, named by their numbers."""
    events: dict[str, Event] = dict(system.events_by_name)
    chains = []
    for number, path in enumerate(found, start=1):
        chain, own = path.chain(str(number))
        chains.append(chain)
        events.update((event.name, event) for event in own)
    return replace(system, events=Events(events=tuple(events.values()), chains=tuple(chains)))
