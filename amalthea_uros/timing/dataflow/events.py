"""Where the events of a model occur in the jobs of its processes."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from enum import Enum
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import (
    AccessKind,
    Activity,
    Call,
    LabelAccess,
    ModeAccess,
    ModeOperation,
    RaiseEvent,
    Receive,
    SemaphoreAccess,
    SemaphoreOperation,
    Send,
    SenderReceiverAccess,
)
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
from amalthea_uros.perf.network import OFF_WIRE_EVENT
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.system import System
from amalthea_uros.timing.jobs.counters import CallSites
from amalthea_uros.timing.jobs.positions import ActivityPosition, positions

#: The class of the events that an activity can raise, and the name of the object that it accesses.
_Accessed: TypeAlias = tuple[type[Event], str]


class UnraisedError(UnknownError):
    """No activity of the model raises an event, so that it is unknown when it occurs."""


class JobPhase(Enum):
    """A phase of a job, in order."""

    ACTIVATION = 0
    START = 1
    BEFORE = 2
    AFTER = 3
    END = 4


@dataclass(frozen=True, slots=True)
class EventOccurrence:
    """Where an event occurs.

    Attributes
    ----------
    position : the activity before or after which it occurs; None: the activation, the start or the end of the job
    """

    process: Process
    when: JobPhase
    position: ActivityPosition | None = None

    @property
    def order(self) -> tuple[int, int, int, int]:
        """Sorts by the order in a job."""
        if self.position is None:
            return (self.when.value if self.when is not JobPhase.END else 9, 0, 0, 0)
        if self.when is JobPhase.BEFORE:
            return (2, self.position.number, 0, 0)
        # A call ends after everything within it; of several calls that end together, the inner one ends first.
        return (2, self.position.last, 1, -self.position.number)


@dataclass(slots=True)
class EventLocator:
    """Finds events in the processes of a system."""

    system: System
    sites: CallSites = field(init=False)
    #: The text says why there are none.
    _positions: dict[str, list[ActivityPosition] | str] = field(default_factory=dict)
    _by_accessed: dict[str, dict[_Accessed, list[ActivityPosition]]] = field(default_factory=dict)
    _accessing_processes: dict[_Accessed, list[str]] | None = None

    def __post_init__(self) -> None:
        self.sites = CallSites(self.system)

    def keep(self, other: EventLocator, processes: Collection[str]) -> None:
        """Take over what another one knows of processes that are the same."""
        self._positions |= {name: known for name, known in other._positions.items() if name in processes}
        self._by_accessed |= {name: known for name, known in other._by_accessed.items() if name in processes}

    def positions(self, process: str) -> list[ActivityPosition]:
        """Everything that the jobs of a process do.

        Raises
        ------
        UnknownError : it executes too many activities.
        """
        found = self._positions.get(process)
        if found is None:
            try:
                found = positions(self.system.processes[process], self.system, self.sites)
            except UnknownError as error:
                found = str(error)
            self._positions[process] = found
        if isinstance(found, str):
            raise UnknownError(found)
        return found

    def all_positions(self) -> Iterator[ActivityPosition]:
        """Everything that the jobs of all processes do; raises as `positions`."""
        for process in self.system.processes:
            yield from self.positions(process)

    def raising(self, event: Event) -> list[ActivityPosition]:
        """The positions of the activities that raise an event, process by process.

        Raises
        ------
        UnknownError : a process in which it could occur executes too many activities.
        """
        process = None if isinstance(event, CustomEvent) else getattr(event, "process", None)
        if process is not None and process not in self.system.processes:
            return []
        accessed = _accessed_by(event)
        if accessed is None:
            found = self.all_positions() if process is None else iter(self.positions(process))
        else:
            within = self._processes_accessing(accessed) if process is None else (process,)
            found = (position for name in within for position in self._accessing(name).get(accessed, ()))
        return [position for position in found if raises(position, event)]

    def _processes_accessing(self, accessed: _Accessed) -> Sequence[str]:
        """The processes with an activity that accesses an object; raises as `positions`."""
        if self._accessing_processes is None:
            by_process = {name: self._accessing(name) for name in self.system.processes}
            found: dict[_Accessed, list[str]] = {}
            for name, own in by_process.items():
                for each in own:
                    found.setdefault(each, []).append(name)
            self._accessing_processes = found
        return self._accessing_processes.get(accessed, ())

    def _accessing(self, process: str) -> dict[_Accessed, list[ActivityPosition]]:
        """The positions of a process by what their activities access."""
        if process not in self._by_accessed:
            found: dict[_Accessed, list[ActivityPosition]] = {}
            for position in self.positions(process):
                accessed = _accessed(position.activity)
                if accessed is not None:
                    found.setdefault(accessed, []).append(position)
            self._by_accessed[process] = found
        return self._by_accessed[process]

    def of(self, event: Event) -> list[EventOccurrence]:
        """Where an event occurs.

        Raises
        ------
        UnknownError : it does not occur in a process, or cannot be analysed.
        """
        found = list(self._occurrences(event))
        if not found and (callback := self.system.callback_of_host_event.get(event.name)) is not None:
            raise UnknownError(f"{callback.name!r} is a callback of the host")
        if not found and isinstance(event, CustomEvent) and event.kind == OFF_WIRE_EVENT:
            advice = "describe 'transport' and 'agent' of the middleware"
            raise UnraisedError(f"no wire is described for {event.name!r}: {advice}")
        if not found:
            raise UnraisedError(f"no activity in the model raises the event {event.name!r}")
        return found

    def _occurrences(self, event: Event) -> Iterable[EventOccurrence]:
        match event:
            case ProcessEvent():
                when = _PROCESS_PHASES.get(event.change) if event.change else None
                if when is None:
                    raise UnknownError(_no_single_time(event))
                if event.process is None:
                    raise UnknownError("an event has no process")
                process = self.system.processes.get(event.process)
                return [] if process is None else [EventOccurrence(process, when)]
            case StimulusEvent():
                activated = (each for each in self.system.processes.values() if event.stimulus in each.stimuli)
                return [EventOccurrence(each, JobPhase.ACTIVATION) for each in activated]
            case RunnableEvent():
                if event.change not in (RunnableChange.START, RunnableChange.TERMINATE):
                    raise UnknownError(_no_single_time(event))
                when = JobPhase.BEFORE if event.change is RunnableChange.START else JobPhase.AFTER
                return [EventOccurrence(p.process, when, p) for p in self.raising(event)]
            case CustomEvent() | LabelEvent() | ModeLabelEvent() | ChannelEvent() | SemaphoreEvent():
                return [EventOccurrence(p.process, JobPhase.AFTER, p) for p in self.raising(event)]
        raise UnknownError(f"the kind of the event {event.name!r} cannot be analysed")


_PROCESS_PHASES = {
    ProcessChange.ACTIVATE: JobPhase.ACTIVATION,
    ProcessChange.START: JobPhase.START,
    ProcessChange.TERMINATE: JobPhase.END,
}


def _no_single_time(event: ProcessEvent | RunnableEvent) -> str:
    kind = f"{event.change} events do not" if event.change else "the event has no event type, so it does not"
    return f"{event.name!r}: {kind} mark a single time in each job"


_MODES = {
    ModeChange.READ: ModeOperation.READ,
    ModeChange.WRITE: ModeOperation.SET,
    ModeChange.INCREMENT: ModeOperation.INCREMENT,
    ModeChange.DECREMENT: ModeOperation.DECREMENT,
}


def _accessed(activity: Activity) -> _Accessed | None:
    """What an activity accesses, as the key of the events that it raises; None if it raises none."""
    match activity:
        case LabelAccess(label=name) | SenderReceiverAccess(label=name):
            return (LabelEvent, name)
        case Call(runnable=name):
            return (RunnableEvent, name)
        case RaiseEvent(event=name):
            return (CustomEvent, name)
        case ModeAccess(label=name):
            return (ModeLabelEvent, name)
        case Send(channel=name) | Receive(channel=name):
            return (ChannelEvent, name)
        case SemaphoreAccess(semaphore=name):
            return (SemaphoreEvent, name)
    return None


def _accessed_by(event: Event) -> _Accessed | None:
    """The key of the activities that can raise an event; None if the event does not name the object."""
    name: str | None = None
    match event:
        case LabelEvent(label=name) | ModeLabelEvent(label=name) | RunnableEvent(runnable=name) | CustomEvent(name=name):
            pass
        case ChannelEvent(channel=name) | SemaphoreEvent(semaphore=name):
            pass
    return None if name is None else (type(event), name)


def raises(position: ActivityPosition, event: Event) -> bool:
    """Whether an activity raises an event; unset features of the event match everything."""
    match event, position.activity:
        case CustomEvent(name=name), RaiseEvent(event=raised):
            return name == raised
        case RunnableEvent(runnable=wanted, process=process), Call(runnable=name):
            return wanted in (None, name) and process in (None, position.process.name)
        case ((LabelEvent() | ModeLabelEvent() | ChannelEvent() | SemaphoreEvent()), _):
            is_here = event.process in (None, position.process.name) and event.runnable in (None, position.runnable)
            return is_here and _accesses(position, event)
    return False


def _accesses(position: ActivityPosition, event: LabelEvent | ModeLabelEvent | ChannelEvent | SemaphoreEvent) -> bool:
    match event, position.activity:
        case LabelEvent(label=wanted, change=change), LabelAccess(label=name, kind=kind) | SenderReceiverAccess(
            label=name, kind=kind
        ):
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
