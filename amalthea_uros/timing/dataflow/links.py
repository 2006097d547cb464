"""The links between processes: data that one writes and another reads, triggers, events and server calls.

Chains, paths and rules all use these links.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from enum import StrEnum
from functools import cached_property
from itertools import chain
from typing import NamedTuple

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.perf.activities import (
    AccessKind,
    Call,
    Communication,
    LabelAccess,
    ModeAccess,
    ModeOperation,
    Receive,
    Send,
    SenderReceiverAccess,
    ServerCall,
    ServerCallKind,
    SetEvent,
    Trigger,
    WaitEvent,
)
from amalthea_uros.perf.conditions import read_by
from amalthea_uros.perf.events import RunnableChange, RunnableEvent
from amalthea_uros.perf.stimuli import EventTriggered
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.events import EventLocator, EventOccurrence, JobPhase
from amalthea_uros.timing.jobs.executed import with_direct_calls
from amalthea_uros.timing.jobs.positions import ActivityPosition

#: The names of the objects that an activity accesses in one way; empty for most activities.
NamesOf = Callable[[ActivityPosition], tuple[str, ...]]
#: Accesses by the names of the data.
_Accesses = dict[str, list[ActivityPosition]]


class LinkKind(StrEnum):
    """How an event causes the next one."""

    JOB = "the same job"
    NEXT_JOB = "the next job"
    TRIGGER = "a trigger"
    DATA = "data"
    MESSAGE = "a message"
    QUEUE = "a message that waits"
    RELAY = "a message through the agent"
    OS_EVENT = "an OS event"
    SERVER_CALL = "a server call"
    NOTHING = "nothing"


#: Where nothing takes the effect on.
GAPS = (LinkKind.NOTHING, LinkKind.NEXT_JOB)
#: Links for which the time of the effect in the jobs is unknown, or the time that a message takes.
UNTIMED = (*GAPS, LinkKind.OS_EVENT, LinkKind.SERVER_CALL, LinkKind.MESSAGE)


@dataclass(frozen=True, slots=True)
class Link:
    """From one event to the next.

    Attributes
    ----------
    names : labels, channels, OS events or server runnables, or the stimulus
    write, read : where the data are written and read, or the trigger is fired
    is_before : whether the trigger is fired when `write` starts, not when it ends
    """

    kind: LinkKind
    names: tuple[str, ...] = ()
    write: ActivityPosition | None = None
    read: ActivityPosition | None = None
    is_before: bool = False


class Firing(NamedTuple):
    """An activity that fires a stimulus when it ends, or, if `is_before`, when it starts."""

    stimulus: str
    position: ActivityPosition
    is_before: bool = False


class DirectLink(NamedTuple):
    """From one process to another one, by the name of a label, channel, OS event, server runnable or stimulus."""

    kind: LinkKind
    source: str
    name: str
    target: str


@dataclass
class Dataflow:
    """The positions of activities in jobs, and the links between jobs; results are cached.

    Attributes
    ----------
    communication : overrides that of the accesses to labels; None: as modelled, implicit by default
    """

    system: System
    communication: Communication | None = None
    events: EventLocator = field(init=False)
    _named: dict[tuple[str, NamesOf], _Accesses] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.system = with_direct_calls(self.system)
        self.events = EventLocator(self.system)

    def with_counters(self, system: System) -> Dataflow:
        """The same for a system whose processes differ in the offsets of counters; what is known of equal ones is kept."""
        dataflow = Dataflow(system, self.communication)
        same = {name for name, process in dataflow.system.processes.items() if process is self.system.processes.get(name)}
        dataflow._named |= {key: accesses for key, accesses in self._named.items() if key[0] in same}
        dataflow.events.keep(self.events, same)
        return dataflow

    def links(self, first: EventOccurrence, then: EventOccurrence) -> tuple[Link, ...]:
        """All links that can take the effect from one event to another: nobody states which of them is meant."""
        if first.process.name == then.process.name:
            if first.order <= then.order:
                return self._returning(first, then) or (Link(LinkKind.JOB),)
            return self.data(first, then)
        if stated := self._between_accesses(first, then):
            return stated
        is_activation = then.when is JobPhase.ACTIVATION
        # An activation cannot cause another activation: only a job can trigger.
        can_trigger = not (is_activation and first.when is JobPhase.ACTIVATION)
        triggers = self.triggers(first.process.name, then.process.name) if can_trigger else ()
        if is_activation and triggers:
            return triggers
        return (*triggers, *self.data(first, then), *self._synchronisation(first, then))

    def gap(self, first: EventOccurrence, then: EventOccurrence) -> Link:
        """What stands for a link between two events if there is none: a later job takes notice of the first event."""
        return Link(LinkKind.NEXT_JOB if first.process.name == then.process.name else LinkKind.NOTHING)

    def triggers(self, first: str, then: str) -> tuple[Link, ...]:
        """How a process activates another one."""
        return tuple(
            Link(LinkKind.TRIGGER, (firing.stimulus,), firing.position, is_before=firing.is_before)
            for firing in self.firings(first)
            if firing.stimulus in self.system.processes[then].stimuli
        )

    def data(self, first: EventOccurrence, then: EventOccurrence) -> tuple[Link, ...]:
        """The data written at one event and read at the other one."""
        return self._shared(first, self._accesses(first, writes), then, self._accesses(then, reads))

    def _returning(self, first: EventOccurrence, then: EventOccurrence) -> tuple[Link, ...]:
        """The topics of messages that a job sends to a later job of its own process."""
        if first.position is None or then.position is None:
            return ()
        links = self._shared(first, self._own_accesses(first, writes), then, self._own_accesses(then, reads))
        return tuple(link for link in links if link.kind is LinkKind.MESSAGE)

    def _between_accesses(self, first: EventOccurrence, then: EventOccurrence) -> tuple[Link, ...]:
        """The data if both events are accesses to the same: so it is stated that they are meant."""
        if (
            first.position is None
            or then.position is None
            or isinstance(first.position.activity, Call)
            or isinstance(then.position.activity, Call)
        ):
            return ()
        return self._shared(first, _grouped([first.position], writes), then, _grouped([then.position], reads))

    def _shared(self, first: EventOccurrence, written: _Accesses, then: EventOccurrence, read: _Accesses) -> tuple[Link, ...]:
        """Links for the data that are both written and read; topics only if there are no others, because they take longest.

        Data that are visible at the same times are one link.
        """
        shared = [name for name in written if name in read]
        inside = [name for name in shared if not self.is_topic(name)]
        kind = LinkKind.DATA if inside else LinkKind.MESSAGE
        names: dict[tuple[Hashable, ...], list[str]] = {}
        for name in inside or shared:
            # The last write counts, and the first read after which the data are there.
            write, access = written[name][-1], read[name][0]
            if write.process.name == access.process.name:
                alike: tuple[Hashable, ...] = (write.number, access.number)
            else:
                alike = (self._visible(write, first), self._visible(access, then))
            names.setdefault(alike, []).append(name)
        return tuple(Link(kind, tuple(own), written[own[0]][-1], read[own[0]][0]) for own in names.values())

    def _visible(self, position: ActivityPosition, occurrence: EventOccurrence) -> Hashable:
        """The same for all accesses of jobs that an event precedes, or that it follows, by which data are visible at the same times."""
        if communication_of(position, self.communication) is Communication.EXPLICIT:
            return position.number
        own = occurrence.position
        is_later = own is not None and position.number > own.number
        times = position.activity.times if isinstance(position.activity, LabelAccess) else None
        return (
            *((id(activities), index) for activities, index in position.outer[:-1]),
            id(position.outer[-1][0]),
            times,
            is_later,
        )

    def is_topic(self, name: str) -> bool:
        """Whether a name is a channel whose messages leave the system."""
        channel = self.system.channels.get(name)
        return channel is not None and channel.external

    def direct(self) -> Iterator[DirectLink]:
        """All links between different processes."""
        for kind, source, target in ((LinkKind.DATA, writes, reads), *_SYNCHRONISATION):
            consumers: dict[str, list[str]] = {}
            for process in self.system.processes:
                for name in self.by_name(process, target):
                    consumers.setdefault(name, []).append(process)
            for process in self.system.processes:
                for name in self.by_name(process, source):
                    found = LinkKind.MESSAGE if kind is LinkKind.DATA and self.is_topic(name) else kind
                    yield from (
                        DirectLink(found, process, name, other) for other in consumers.get(name, ()) if other != process
                    )
        for process in self.system.processes:
            for stimulus in (firing.stimulus for firing in self.firings(process)):
                others = (other for other in self.activated.get(stimulus, ()) if other != process)
                yield from (DirectLink(LinkKind.TRIGGER, process, stimulus, other) for other in others)

    @cached_property
    def activated(self) -> Mapping[str, list[str]]:
        """The processes that each stimulus activates."""
        found: dict[str, list[str]] = {}
        for process in self.system.processes.values():
            for stimulus in process.stimuli:
                found.setdefault(stimulus, []).append(process.name)
        return found

    def by_name(self, process: str, names_of: NamesOf) -> _Accesses:
        """The accesses of a process, by the names of the data."""
        key = (process, names_of)
        if key not in self._named:
            self._named[key] = _grouped(self.events.positions(process), names_of)
        return self._named[key]

    def fired_at(self, stimulus: str) -> list[ActivityPosition]:
        """The positions at which processes fire a stimulus."""
        return self._fired_at.get(stimulus, [])

    @cached_property
    def _fired_at(self) -> dict[str, list[ActivityPosition]]:
        found: dict[str, list[ActivityPosition]] = {}
        for firing in chain.from_iterable(map(self.firings, self.system.processes)):
            found.setdefault(firing.stimulus, []).append(firing.position)
        return found

    def firings(self, process: str) -> list[Firing]:
        """The stimuli that a process fires, in order, by triggers and by the events that it raises."""
        return self._fired[process]

    @cached_property
    def _fired(self) -> dict[str, list[Firing]]:
        found = {
            name: [Firing(stimulus, each) for stimulus, fired in self.by_name(name, _triggers).items() for each in fired]
            for name in self.system.processes
        }
        events, stimuli = self.system.events_by_name, self.system.stimuli.stimuli
        reacting = [(each.name, name) for each in stimuli if isinstance(each, EventTriggered) for name in each.events]
        for stimulus, event in ((stimulus, events[name]) for stimulus, name in reacting if name in events):
            is_before = isinstance(event, RunnableEvent) and event.change is not RunnableChange.TERMINATE
            for position in self.events.raising(event):
                found[position.process.name].append(Firing(stimulus, position, is_before))
        return {name: sorted(own, key=lambda firing: firing.position.number) for name, own in found.items()}

    def _synchronisation(self, first: EventOccurrence, then: EventOccurrence) -> tuple[Link, ...]:
        """The synchronisation of two processes by OS events, or by calls of server runnables and their results."""
        found = []
        for kind, source, target in _SYNCHRONISATION:
            written, read = self.by_name(first.process.name, source), self.by_name(then.process.name, target)
            if names := tuple(name for name in written if name in read):
                found.append(Link(kind, names))
        return tuple(found)

    def _accesses(self, occurrence: EventOccurrence, names_of: NamesOf) -> _Accesses:
        """The data written or read at an event, or else anywhere in its process."""
        return self._own_accesses(occurrence, names_of) or self.by_name(occurrence.process.name, names_of)

    def _own_accesses(self, occurrence: EventOccurrence, names_of: NamesOf) -> _Accesses:
        """The data written or read at an event: by the access itself, or in its runnable."""
        position = occurrence.position
        if position is None:
            return {}
        if not isinstance(position.activity, Call) and names_of(position):
            return _grouped([position], names_of)
        runnable = position.activity.runnable if isinstance(position.activity, Call) else position.runnable
        return _grouped(
            (
                each
                for each in self.events.positions(occurrence.process.name)
                # The condition of a call is part of it.
                if each.runnable == runnable or each.number == position.number
            ),
            names_of,
        )


def communication_of(position: ActivityPosition | None, communication: Communication | None) -> Communication:
    """When what is written at a position becomes visible, or what is read there is fetched.

    Only labels can be copied at the start and the end of a job: modes and messages are written and read in place.

    Parameters
    ----------
    communication : overrides that of accesses to labels
    """
    match position.activity if position is not None else None:
        case LabelAccess(communication=stated):
            return communication or stated or Communication.IMPLICIT
        case None | SenderReceiverAccess():
            return communication or Communication.IMPLICIT
    return Communication.EXPLICIT


def writes(position: ActivityPosition) -> tuple[str, ...]:
    """The labels, mode labels and channels that an activity writes."""
    match position.activity:
        case LabelAccess(label=name, kind=AccessKind.WRITE) | SenderReceiverAccess(label=name, kind=AccessKind.WRITE):
            return (name,)
        case Send(channel=name):
            return (name,)
        case ModeAccess(label=name, operation=operation) if operation is not ModeOperation.READ:
            return (name,)
    return ()


def reads(position: ActivityPosition) -> tuple[str, ...]:
    """The labels, mode labels and channels that an activity reads, or on which a condition depends."""
    if position.conditions:
        return tuple(name for condition in position.conditions for name in read_by(condition))
    match position.activity:
        case LabelAccess(label=name, kind=AccessKind.READ) | SenderReceiverAccess(label=name, kind=AccessKind.READ):
            return (name,)
        case Receive(channel=name) | ModeAccess(label=name):
            return (name,)
    return ()


def _triggers(position: ActivityPosition) -> tuple[str, ...]:
    """The stimulus that an activity triggers."""
    match position.activity:
        case Trigger(stimulus=name):
            return (name,)
    return ()


def _sets(position: ActivityPosition) -> tuple[str, ...]:
    """OS events, for one process or for all."""
    match position.activity:
        case SetEvent(events=events, process=process):
            return tuple(event if process is None else f"{event} of {process}" for event in events)
    return ()


def _awaits(position: ActivityPosition) -> tuple[str, ...]:
    match position.activity:
        case WaitEvent(events=events):
            return tuple(name for event in events for name in (event, f"{event} of {position.process.name}"))
    return ()


def _requests(position: ActivityPosition) -> tuple[str, ...]:
    """The runnables that other processes execute for this one, or because of it."""
    match position.activity:
        case ServerCall(kind=ServerCallKind.SYNCHRONOUS, waits=False):
            return ()
        case ServerCall(runnable=name, result=result):
            return (name,) if result is None else (name, result)
        case SenderReceiverAccess(notifies=notifies):
            return notifies
    return ()


def _serves(position: ActivityPosition) -> tuple[str, ...]:
    match position.activity:
        case Call(runnable=name):
            return (name,)
    return ()


#: Synchronisation of processes: kind of link, activity of the first process, activity of the second one.
_SYNCHRONISATION: tuple[tuple[LinkKind, NamesOf, NamesOf], ...] = (
    (LinkKind.OS_EVENT, _sets, _awaits),
    (LinkKind.SERVER_CALL, _requests, _serves),
    (LinkKind.SERVER_CALL, _serves, _requests),
)


def _grouped(within: Iterable[ActivityPosition], names_of: NamesOf) -> _Accesses:
    found: _Accesses = {}
    for position in within:
        for name in names_of(position):
            found.setdefault(name, []).append(position)
    return found
