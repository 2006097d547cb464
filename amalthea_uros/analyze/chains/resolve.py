"""What carries the effect from one event of a chain to the next: the order within a job, a trigger, or data.

Each event is looked for in the processes; where several fit, those are taken between which something carries. The names of segments say
nothing: what counts is which label one process writes and the other one reads.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from enum import Enum, StrEnum
from itertools import pairwise, product

from amalthea_uros.analyze.chains.places import Place, places
from amalthea_uros.perf.events import (
    ChannelChange,
    ChannelEvent,
    CustomEvent,
    Event,
    LabelChange,
    LabelEvent,
    ModeChange,
    ModeLabelEvent,
    ProcessChange,
    ProcessEvent,
    RunnableChange,
    RunnableEvent,
    SemaphoreChange,
    SemaphoreEvent,
    StimulusEvent,
)
from amalthea_uros.perf.software import (
    AccessKind,
    Call,
    LabelAccess,
    ModeAccess,
    ModeOperation,
    Process,
    RaiseEvent,
    Receive,
    SemaphoreAccess,
    SemaphoreOperation,
    Send,
    Trigger,
)
from amalthea_uros.perf.stimuli import EventTriggered
from amalthea_uros.perf.system import System

#: More candidates for the events of one sequence are not tried.
MOST_CANDIDATES = 10_000

_NameOf = Callable[[Place], "str | None"]


class UnresolvedError(Exception):
    """An event of a chain is not found, or there is no analysis for it; the text says why."""


class When(Enum):
    """A moment of a job, in the order in which they come."""

    ACTIVATION = 0
    START = 1
    BEFORE = 2
    BEHIND = 3
    END = 4


@dataclass(frozen=True, slots=True)
class Spot:
    """Where an event occurs.

    Attributes
    ----------
    place : an activity before or behind which it is; None: the activation, the start or the end of the job
    """

    process: Process
    when: When
    place: Place | None = None

    @property
    def order(self) -> tuple[int, int, int]:
        """What comes first in a job is less."""
        if self.place is None:
            return (self.when.value if self.when is not When.END else 9, 0, 0)
        return (2, self.place.number, self.when.value)


class Carrier(StrEnum):
    """What takes the effect from one event to the next."""

    JOB = "the same job"
    NEXT_JOB = "the next job"
    TRIGGER = "a trigger"
    DATA = "data"
    NOTHING = "nothing"


@dataclass(frozen=True, slots=True)
class Hop:
    """From one event to the next.

    Attributes
    ----------
    names : of the labels, the channel or the stimulus
    write, read : where the data are written and read, or the trigger is fired
    """

    carrier: Carrier
    names: tuple[str, ...] = ()
    write: Place | None = None
    read: Place | None = None


@dataclass(frozen=True, slots=True)
class Route:
    """A way through a chain: spots, and the hops between them."""

    events: tuple[str, ...]
    spots: tuple[Spot, ...]
    hops: tuple[Hop, ...]

    @property
    def gaps(self) -> int:
        """How often nothing carries the effect."""
        return sum(hop.carrier is Carrier.NOTHING for hop in self.hops)


@dataclass(slots=True)
class Resolver:
    """Finds events in the processes of a system.

    Attributes
    ----------
    guesses : event -> where it is taken to occur, because nothing makes it occur
    """

    system: System
    guesses: dict[str, str] = field(default_factory=dict)
    _places: dict[str, list[Place]] = field(default_factory=dict)
    _named: dict[tuple[str, _NameOf], dict[str, list[Place]]] = field(default_factory=dict)

    def routes(self, events: Sequence[Event]) -> list[Route]:
        """The ways that a sequence of events can mean, those with the fewest gaps.

        Raises
        ------
        UnresolvedError : an event is not found, or there is no analysis for it.
        """
        choices = [self.spots(event) for event in events]
        count = 1
        for choice in choices:
            count *= len(choice)
        if count > MOST_CANDIDATES:
            raise UnresolvedError("its events fit too many processes; they should name theirs")
        names = tuple(event.name for event in events)
        found = [self._route(names, spots) for spots in product(*choices)]
        fewest = min(route.gaps for route in found)
        return [route for route in found if route.gaps == fewest]

    def _route(self, events: tuple[str, ...], spots: tuple[Spot, ...]) -> Route:
        return Route(events, spots, tuple(self._hop(first, then) for first, then in pairwise(spots)))

    # Events

    def spots(self, event: Event) -> list[Spot]:
        """Where an event occurs.

        Raises
        ------
        UnresolvedError : it is not found, or there is no analysis for it.
        """
        found = list(self._all_spots(event)) or self._guess(event)
        if not found:
            raise UnresolvedError(f"nothing in the model makes the event {event.name!r} occur")
        return found

    def _guess(self, event: Event) -> list[Spot]:
        """Where an access should stand of which the model knows no more than the event."""
        match event:
            case LabelEvent() | ModeLabelEvent() | ChannelEvent() | SemaphoreEvent():
                is_read = event.change in (LabelChange.READ, ModeChange.READ, ChannelChange.RECEIVE, SemaphoreChange.LOCK)
                runs = [
                    place
                    for place in self._within(event.process)
                    if isinstance(place.activity, Call) and place.activity.runnable == event.runnable
                ]
                side = "at the start" if is_read else "at the end"
                if runs:
                    self.guesses[event.name] = f"{side} of {event.runnable!r}"
                    return [Spot(place.process, When.BEFORE if is_read else When.BEHIND, place) for place in runs]
                if event.process is not None and event.runnable is None:
                    self.guesses[event.name] = f"{side} of {event.process!r}"
                    return [Spot(p, When.START if is_read else When.END) for p in self._processes(event.process)]
        return []

    def _all_spots(self, event: Event) -> Iterable[Spot]:
        match event:
            case ProcessEvent():
                when = _PROCESS_MOMENTS.get(event.change) if event.change else None
                if when is None:
                    raise UnresolvedError(f"{event.name!r}: {event.change or 'any change'} is no moment that each job has once")
                return [Spot(process, when) for process in self._processes(event.process)]
            case StimulusEvent():
                activated = [p for p in self.system.processes.values() if event.stimulus in p.stimuli]
                return [Spot(process, When.ACTIVATION) for process in activated]
            case RunnableEvent():
                if event.change not in (RunnableChange.START, RunnableChange.TERMINATE):
                    raise UnresolvedError(f"{event.name!r}: {event.change or 'any change'} is no moment that each job has once")
                when = When.BEFORE if event.change is RunnableChange.START else When.BEHIND
                return [
                    Spot(place.process, when, place)
                    for place in self._within(event.process)
                    if isinstance(place.activity, Call) and event.runnable in (None, place.activity.runnable)
                ]
            case CustomEvent():
                everywhere = self._within(None)
                return [
                    Spot(place.process, When.BEHIND, place)
                    for place in everywhere
                    if isinstance(place.activity, RaiseEvent) and place.activity.event == event.name
                ]
            case LabelEvent() | ModeLabelEvent() | ChannelEvent() | SemaphoreEvent():
                return [
                    Spot(place.process, When.BEHIND, place)
                    for place in self._within(event.process)
                    if event.runnable in (None, place.runnable) and _is(event, place)
                ]
        raise UnresolvedError(f"there is no analysis for the event {event.name!r}")

    def _processes(self, name: str | None) -> list[Process]:
        if name is None:
            raise UnresolvedError("an event names no process")
        return [self.system.processes[name]] if name in self.system.processes else []

    def _within(self, name: str | None) -> list[Place]:
        names = [name] if name in self.system.processes else list(self.system.processes) if name is None else []
        return [place for each in names for place in self.places(each or "")]

    def places(self, name: str) -> list[Place]:
        """Everything that the jobs of a process do."""
        if name not in self._places:
            self._places[name] = places(self.system.processes[name], self.system)
        return self._places[name]

    # Hops

    def _hop(self, first: Spot, then: Spot) -> Hop:
        if first.process.name == then.process.name:
            if first.order <= then.order:
                return Hop(Carrier.JOB)
            carried = self._data(first, then)
            return Hop(Carrier.NEXT_JOB) if carried is None else carried
        trigger = self._trigger(first, then)
        if trigger is not None:
            return trigger
        return self._data(first, then) or Hop(Carrier.NOTHING)

    def _trigger(self, first: Spot, then: Spot) -> Hop | None:
        if then.when is When.ACTIVATION and then.process.stimuli and first.when is When.ACTIVATION:
            return None
        raised = {
            name: stimulus.events
            for name in then.process.stimuli
            if isinstance(stimulus := self.system.stimuli_by_name.get(name), EventTriggered)
        }
        for place in self.places(first.process.name):
            match place.activity:
                case Trigger(stimulus=name) if name in then.process.stimuli:
                    return Hop(Carrier.TRIGGER, (name,), place)
                case RaiseEvent(event=event):
                    for name, events in raised.items():
                        if event in events:
                            return Hop(Carrier.TRIGGER, (name,), place)
        return None

    def _accesses(self, spot: Spot, name_of: _NameOf) -> dict[str, list[Place]]:
        """What is written or read where an event occurs: by the access itself, in its runnable, or anywhere in the process."""
        key = (spot.process.name, name_of)
        if key not in self._named:
            self._named[key] = _by_name(self.places(spot.process.name), name_of)
        everything = self._named[key]
        if spot.place is None:
            return everything
        if (own := name_of(spot.place)) is not None:
            return {own: [spot.place]}
        runnable = spot.place.activity.runnable if isinstance(spot.place.activity, Call) else spot.place.runnable
        within = [place for place in self.places(spot.process.name) if place.runnable == runnable]
        return _by_name(within, name_of) or everything

    def _data(self, first: Spot, then: Spot) -> Hop | None:
        """The labels and channels that one process writes, behind an event if it can be, and the other one reads."""
        written = self._accesses(first, _written)
        read = self._accesses(then, _read)
        names = tuple(name for name in written if name in read)
        if not names:
            return None
        # The last write counts, and the first read behind which the data are there.
        return Hop(Carrier.DATA, names, written[names[0]][-1], read[names[0]][0])


_PROCESS_MOMENTS = {
    ProcessChange.ACTIVATE: When.ACTIVATION,
    ProcessChange.START: When.START,
    ProcessChange.TERMINATE: When.END,
}
_MODES = {
    ModeChange.READ: ModeOperation.READ,
    ModeChange.WRITE: ModeOperation.SET,
    ModeChange.INCREMENT: ModeOperation.INCREMENT,
    ModeChange.DECREMENT: ModeOperation.DECREMENT,
}


def _is(event: LabelEvent | ModeLabelEvent | ChannelEvent | SemaphoreEvent, place: Place) -> bool:
    """Whether an activity makes an event occur."""
    match event, place.activity:
        case LabelEvent(label=wanted, change=change), LabelAccess(label=name, kind=kind):
            return wanted in (None, name) and (change is None or (change is LabelChange.READ) is (kind is AccessKind.READ))
        case ModeLabelEvent(label=wanted, change=change), ModeAccess(label=name, operation=operation):
            return wanted in (None, name) and (change is None or _MODES[change] is operation)
        case ChannelEvent(channel=wanted, change=change), Send(channel=name):
            return wanted in (None, name) and change is not ChannelChange.RECEIVE
        case ChannelEvent(channel=wanted, change=change), Receive(channel=name):
            return wanted in (None, name) and change is not ChannelChange.SEND
        case SemaphoreEvent(semaphore=wanted, change=change), SemaphoreAccess(semaphore=name, operation=operation):
            is_release = operation is SemaphoreOperation.RELEASE
            return wanted in (None, name) and (change is None or (change is SemaphoreChange.UNLOCK) is is_release)
    return False


def _written(place: Place) -> str | None:
    match place.activity:
        case LabelAccess(label=name, kind=AccessKind.WRITE) | Send(channel=name):
            return name
        case ModeAccess(label=name, operation=operation) if operation is not ModeOperation.READ:
            return name
    return None


def _read(place: Place) -> str | None:
    match place.activity:
        case LabelAccess(label=name, kind=AccessKind.READ) | Receive(channel=name) | ModeAccess(label=name):
            return name
    return None


def _by_name(within: Iterable[Place], name_of: _NameOf) -> dict[str, list[Place]]:
    by_name: dict[str, list[Place]] = {}
    for place in within:
        if (name := name_of(place)) is not None:
            by_name.setdefault(name, []).append(place)
    return by_name
