"""What is observed besides jobs and chains, because something in the model limits it: sources of events, executions of runnables."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from enum import StrEnum

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.perf.activities import Communication
from amalthea_uros.perf.constraints import (
    ChainEnd,
    ChainSynchronization,
    Constraint,
    DelayConstraint,
    EventSynchronization,
    RepetitionConstraint,
)
from amalthea_uros.perf.events import (
    ChannelEvent,
    CustomEvent,
    Event,
    EventSet,
    LabelEvent,
    ModeLabelEvent,
    ProcessChange,
    ProcessEvent,
    RunnableChange,
    RunnableEvent,
    SemaphoreEvent,
    StimulusEvent,
)
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.events import EventLocator
from amalthea_uros.timing.dataflow.runnable_order import OrderScope, order_scope
from amalthea_uros.trace.table import EventKind

#: The kinds of transitions of a process.
_KINDS = {
    ProcessChange.ACTIVATE: EventKind.ACTIVATE,
    ProcessChange.START: EventKind.START,
    ProcessChange.PREEMPT: EventKind.PREEMPT,
    ProcessChange.RESUME: EventKind.RESUME,
    ProcessChange.TERMINATE: EventKind.TERMINATE,
    ProcessChange.POLL: EventKind.POLL,
    ProcessChange.RUN: EventKind.RUN,
    ProcessChange.PARK: EventKind.PARK,
    ProcessChange.POLL_PARKING: EventKind.POLL_PARKING,
    ProcessChange.RELEASE_PARKING: EventKind.RELEASE_PARKING,
    ProcessChange.WAIT: EventKind.WAIT,
    ProcessChange.RELEASE: EventKind.RELEASE,
}


@dataclass(frozen=True, slots=True)
class EventSource:
    """Where events occur that the simulation does not tell apart.

    Attributes
    ----------
    kind : class of the events
    name : of the object
    runnable : which accesses the object, or calls it; None: the process itself does
    process : None for stimuli
    communication : of an access to a label
    """

    kind: type[Event]
    name: str
    change: StrEnum | None = None
    runnable: str | None = None
    process: str | None = None
    communication: Communication | None = None


def is_source(source: EventSource, event: Event) -> bool:
    """Whether an event occurs at a source, apart from its core; unset features of the event match everything."""
    name: str | None = None
    runnable = getattr(event, "runnable", None)
    match event:
        case ProcessEvent(process=name) | StimulusEvent(stimulus=name) | CustomEvent(name=name):
            pass
        case RunnableEvent(runnable=name):
            runnable = None  # it is the one that is called, not the one that calls it
        case LabelEvent(label=name) | ModeLabelEvent(label=name) | ChannelEvent(channel=name) | SemaphoreEvent(semaphore=name):
            pass
    wanted = (name, getattr(event, "change", None), runnable, getattr(event, "process", None))
    found = (source.name, source.change, source.runnable, source.process)
    return type(event) is source.kind and all(each in (None, there) for each, there in zip(wanted, found, strict=True))


@dataclass(frozen=True, slots=True)
class Watched:
    """What is to be observed in a system besides jobs and chains.

    Attributes
    ----------
    events : that constraints refer to
    ordered : processes whose calls are observed
    labels : whose accesses are observed
    runnables : whose executions are measured
    """

    events: tuple[Event, ...] = ()
    ordered: frozenset[str] = frozenset()
    labels: frozenset[str] = frozenset()
    runnables: tuple[str, ...] = ()

    def __contains__(self, source: EventSource) -> bool:
        """Whether occurrences at a source are observed."""
        return (
            any(is_source(source, event) for event in self.events)
            or (source.process in self.ordered and is_of_order(source))
            or (bool(self.labels) and is_of_label(source, self.labels))
        )


def is_of_order(source: EventSource) -> bool:
    """Whether a source says in which order a process calls runnables."""
    if source.kind is RunnableEvent:
        return source.change is RunnableChange.START and source.runnable is None
    return source.kind is ProcessEvent and source.change in (ProcessChange.START, ProcessChange.TERMINATE)


def is_of_label(source: EventSource, labels: Collection[str]) -> bool:
    """Whether a source says which value is read and written: an access, or the beginning or end of what keeps values."""
    if source.kind is LabelEvent:
        return source.name in labels
    phases = (ProcessChange.ACTIVATE, ProcessChange.START, ProcessChange.TERMINATE)
    return source.kind is ProcessEvent and source.change in phases


def watched(system: System, labels: Iterable[str]) -> Watched:
    """What the constraints and requirements of a system refer to, and some labels."""
    constraints = system.constraints
    names = [name for constraint in constraints.constraints for name in event_names(constraint, system)]
    events = EventLocator(system)
    scopes = [order_scope(order, system, events) for order in constraints.orders]
    measured = (requirement.runnable for requirement in constraints.requirements)
    return Watched(
        events=(*simple_events(names, system), *(event for each in scopes for event in events_of_order(each))),
        ordered=frozenset(process for each in scopes for process in each.alone),
        labels=frozenset((*labels, *(age.label for age in constraints.data_ages))),
        runnables=tuple(dict.fromkeys(name for name in measured if name is not None)),
    )


def events_of_order(scope: OrderScope) -> Iterator[RunnableEvent]:
    """What is observed of runnables that several processes call in an order: their starts and ends."""
    for name, call in scope.together.items():
        for change in (RunnableChange.START, RunnableChange.TERMINATE):
            yield RunnableEvent(name=name, runnable=name, change=change, process=call.process.name)


def event_names(constraint: Constraint, system: System) -> list[str]:
    """The events that a constraint refers to; none if it is about the latency of a chain."""
    match constraint:
        case DelayConstraint(source=source, target=target):
            return [source, target]
        case RepetitionConstraint(event=event):
            return [event]
        case EventSynchronization(events=events):
            return list(dict.fromkeys(events))
        case ChainSynchronization(chains=chains, end=end):
            found = [system.chains[name] for name in chains if name in system.chains]
            ends = [chain.stimulus if end is ChainEnd.STIMULUS else chain.response for chain in found]
            return list(dict.fromkeys(name for name in ends if name is not None))
    return []


def simple_events(names: Iterable[str], system: System) -> Iterator[Event]:
    """The events with these names, and those of sets instead of the sets."""
    for name in dict.fromkeys(names):
        match system.events_by_name.get(name):
            case None:
                pass
            case EventSet(events=events):
                yield from simple_events((each for each in events if each != name), system)
            case event:
                yield event


@dataclass(slots=True)
class Watches:
    """The sources that are watched in a program, and their numbers.

    Attributes
    ----------
    measured : numbers of the runnables whose executions are measured
    sources : in the order of their numbers
    """

    watched: Watched
    measured: dict[str, int] = field(default_factory=dict)
    sources: dict[EventSource, int] = field(default_factory=dict)
    _unwatched: set[EventSource] = field(default_factory=set)

    def number(self, source: EventSource) -> int | None:
        """The number of a source; None if it is not watched."""
        if source not in self.sources and source not in self._unwatched:
            if source in self.watched:
                self.sources[source] = len(self.sources)
            else:
                self._unwatched.add(source)
        return self.sources.get(source)

    def transitions(self, process: str) -> list[int]:
        """For each kind of transition of a process the number of its source plus 1, or 0; empty if none is watched."""
        found = [0] * (max(_KINDS.values()) + 1)
        for change, kind in _KINDS.items():
            number = self.number(EventSource(ProcessEvent, process, change, None, process))
            found[kind] = 0 if number is None else number + 1
        return found if any(found) else []
