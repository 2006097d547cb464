"""Where the events of a model occur in the jobs of its processes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import Enum

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
)
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.positions import Place, places


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
    def order(self) -> tuple[int, int, int, int]:
        """What comes first in a job is less."""
        if self.place is None:
            return (self.when.value if self.when is not When.END else 9, 0, 0, 0)
        if self.when is When.BEFORE:
            return (2, self.place.number, 0, 0)
        # The end of a call comes behind everything within it, and of several that end together the inner one first.
        return (2, self.place.last, 1, -self.place.number)


@dataclass(slots=True)
class Spots:
    """Finds events in the processes of a system.

    Attributes
    ----------
    guesses : event -> where it is taken to occur, because nothing makes it occur
    """

    system: System
    guesses: dict[str, str] = field(default_factory=dict)
    _places: dict[str, list[Place]] = field(default_factory=dict)

    def of(self, event: Event) -> list[Spot]:
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
