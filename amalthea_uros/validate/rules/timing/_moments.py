"""Where in the jobs of processes events occur."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import chain
from math import inf

from amalthea_uros.metamodel.classes import (
    ChannelEvent,
    ChannelEventType,
    ChannelReceive,
    ChannelSend,
    CustomEvent,
    CustomEventTrigger,
    Event,
    IExecutable,
    LabelAccess,
    LabelAccessEnum,
    LabelEvent,
    LabelEventType,
    ModeLabelAccess,
    ModeLabelAccessEnum,
    ModeLabelEvent,
    ModeLabelEventType,
    Process,
    ProcessEvent,
    ProcessEventType,
    Runnable,
    RunnableCall,
    RunnableEvent,
    RunnableEventType,
    SemaphoreAccess,
    SemaphoreAccessEnum,
    SemaphoreEvent,
    SemaphoreEventType,
    SenderReceiverRead,
    SenderReceiverWrite,
    Stimulus,
    StimulusEvent,
)
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.execution import called, calls, executing, order
from amalthea_uros.validate.graphs import bottom_up

AccessEvent = LabelEvent | ModeLabelEvent | ChannelEvent | SemaphoreEvent
AccessType = LabelEventType | ModeLabelEventType | ChannelEventType | SemaphoreEventType

#: Moments of a job before and behind everything that it does.
ACTIVATION, START, END = -2, -1, inf


@dataclass(frozen=True, slots=True)
class Spot:
    """Where an event occurs.

    Attributes
    ----------
    first, last : its first and its last position in a job
    home : the process or runnable whose accesses belong to it; None: all of the job
    item : what makes it occur, if it is an access
    """

    process: Process
    first: float
    last: float
    home: IExecutable | None = None
    item: Element | None = None


@dataclass(slots=True)
class _Layout:
    """The positions of the items of a process or runnable, between which lies what the runnables do that they call."""

    begins: dict[Element, int] = field(default_factory=dict)
    ends: dict[Element, int] = field(default_factory=dict)
    size: int = 0


class Moments:
    """Finds the events of a model; what is asked for is found once."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._layouts: dict[IExecutable, _Layout] = {}
        self._starts: dict[Process, dict[IExecutable, tuple[int, int]]] = {}
        self._spots: dict[Event, list[Spot]] = {}
        for executable in order(context):
            self._layouts[executable] = self._layout(executable)

    def of(self, event: Event) -> list[Spot]:
        """Where an event occurs; nowhere if that is not known, or if it is no moment that each job has once."""
        if event not in self._spots:
            self._spots[event] = list(self._find(event))
        return self._spots[event]

    def _find(self, event: Event) -> Iterable[Spot]:
        match event:
            case ProcessEvent(entity=Process() as process, event_type=change) if change in _CHANGES:
                return [Spot(process, _CHANGES[change], _CHANGES[change])]
            case StimulusEvent(entity=Stimulus() as stimulus):
                return [Spot(process, ACTIVATION, ACTIVATION) for process in self._context.once(_activated).get(stimulus, ())]
            case RunnableEvent(event_type=RunnableEventType.START | RunnableEventType.TERMINATE):
                return self._runs(event.entity, event.process, event.event_type is RunnableEventType.START)
            case CustomEvent():
                return self._items(self._context.once(_raising).get(event, ()), None)
            case LabelEvent() | ModeLabelEvent() | ChannelEvent() | SemaphoreEvent():
                return list(self._items(self._accesses(event), event.process)) or self._guess(event)
        return ()

    def _accesses(self, event: AccessEvent) -> Iterator[Element]:
        known = self._context.once(_accesses)
        accesses = chain(*known.values()) if event.entity is None else known.get(event.entity, ())
        for kind, item in accesses:
            is_of_type = isinstance(kind, _TYPES[type(event)]) and event.event_type in (None, "_all_", kind)
            if is_of_type and event.runnable in (None, item.enclosing(Runnable)):
                yield item

    def _items(self, items: Iterable[Element], wanted: Process | None) -> Iterator[Spot]:
        """The moments behind items."""
        for item in items:
            for process, home in self._executed(item, wanted):
                yield self._spot(process, home, self._layouts[home].ends[item], home, item)

    def _runs(self, runnable: Runnable | None, wanted: Process | None, is_start: bool) -> Iterator[Spot]:
        """The starts or ends of a runnable; None: of any."""
        for call in self._context.once(_callers).get(runnable, ()) if runnable is not None else self._context.all(RunnableCall):
            for process, home in self._executed(call, wanted):
                layout = self._layouts[home]
                yield self._spot(process, home, (layout.begins if is_start else layout.ends)[call], call.runnable)

    def _executed(self, item: Element, wanted: Process | None) -> Iterator[tuple[Process, IExecutable]]:
        """The processes in which an item is executed, and the process or runnable in which it stands."""
        home = item.enclosing(IExecutable)
        if home is not None:
            yield from ((process, home) for process in executing(home, self._context) if wanted in (None, process))

    def _spot(
        self,
        process: Process,
        holder: IExecutable,
        offset: int,
        home: IExecutable | None,
        item: Element | None = None,
    ) -> Spot:
        first, last = self.starts(process)[holder]
        return Spot(process, first + offset, last + offset, home, item)

    def _guess(self, event: AccessEvent) -> Iterable[Spot]:
        """Where an access should stand of which the model knows no more than the event."""
        is_start = event.event_type in _AT_START
        if event.runnable is not None:
            return self._runs(event.runnable, event.process, is_start)
        moment = START if is_start else END
        return [Spot(event.process, moment, moment)] if event.process is not None else []

    # Positions

    def _layout(self, executable: IExecutable) -> _Layout:
        found = _Layout()
        for item in executable.activity_graph.walk() if executable.activity_graph is not None else ():
            inner = self._layouts.get(item.runnable) if isinstance(item, RunnableCall) and item.runnable is not None else None
            found.begins[item] = found.size
            found.ends[item] = found.size + 1 + (inner.size if inner is not None else 0)
            found.size = found.ends[item] + 1
        return found

    def starts(self, process: Process) -> dict[IExecutable, tuple[int, int]]:
        """Where in a job everything that it executes starts, for the first and for the last time."""
        if process not in self._starts:
            top: IExecutable = process
            found: dict[IExecutable, tuple[int, int]] = {top: (0, 0)}
            for caller in reversed(bottom_up([top], lambda one: called(one, self._context))):
                for call in calls(self._context).get(caller, ()):
                    if call.runnable is not None:
                        first, last = (start + self._layouts[caller].begins[call] + 1 for start in found[caller])
                        before = found.get(call.runnable, (first, last))
                        found[call.runnable] = min(first, before[0]), max(last, before[1])
            self._starts[process] = found
        return self._starts[process]


_CHANGES: dict[ProcessEventType | None, float] = {
    ProcessEventType.ACTIVATE: ACTIVATION,
    ProcessEventType.START: START,
    ProcessEventType.TERMINATE: END,
}
_TYPES: dict[type[Event], type[AccessType]] = {
    LabelEvent: LabelEventType,
    ModeLabelEvent: ModeLabelEventType,
    ChannelEvent: ChannelEventType,
    SemaphoreEvent: SemaphoreEventType,
}
_AT_START = {LabelEventType.READ, ModeLabelEventType.READ, ChannelEventType.RECEIVE, SemaphoreEventType.LOCK}
_LABELS: dict[LabelAccessEnum | None, LabelEventType] = {
    LabelAccessEnum.READ: LabelEventType.READ,
    LabelAccessEnum.WRITE: LabelEventType.WRITE,
}
_MODES: dict[ModeLabelAccessEnum | None, ModeLabelEventType] = {
    ModeLabelAccessEnum.READ: ModeLabelEventType.READ,
    ModeLabelAccessEnum.SET: ModeLabelEventType.WRITE,
    ModeLabelAccessEnum.INCREMENT: ModeLabelEventType.INCREMENT,
    ModeLabelAccessEnum.DECREMENT: ModeLabelEventType.DECREMENT,
}


def _accesses(context: Context) -> dict[Element, list[tuple[AccessType, Element]]]:
    """What accesses each label, mode label, channel and semaphore, and as what."""
    found: dict[Element, list[tuple[AccessType, Element]]] = {}
    for cls in (
        LabelAccess,
        SenderReceiverRead,
        SenderReceiverWrite,
        ModeLabelAccess,
        ChannelSend,
        ChannelReceive,
        SemaphoreAccess,
    ):
        for item in context.all(cls):
            data, kind = _access(item)
            if data is not None and kind is not None:
                found.setdefault(data, []).append((kind, item))
    return found


def _access(item: Element) -> tuple[Element | None, AccessType | None]:
    match item:
        case LabelAccess():
            return item.data, _LABELS.get(item.access)
        case SenderReceiverRead():
            return item.label, LabelEventType.READ
        case SenderReceiverWrite():
            return item.label, LabelEventType.WRITE
        case ModeLabelAccess():
            return item.data, _MODES.get(item.access)
        case ChannelSend():
            return item.data, ChannelEventType.SEND
        case ChannelReceive():
            return item.data, ChannelEventType.RECEIVE
        case SemaphoreAccess():
            is_release = item.access is SemaphoreAccessEnum.RELEASE
            return item.semaphore, SemaphoreEventType.UNLOCK if is_release else SemaphoreEventType.LOCK
    return None, None


def _activated(context: Context) -> dict[Stimulus, list[Process]]:
    found: dict[Stimulus, list[Process]] = {}
    for process in context.all(Process):
        for stimulus in process.stimuli:
            found.setdefault(stimulus, []).append(process)
    return found


def _raising(context: Context) -> dict[CustomEvent, list[CustomEventTrigger]]:
    found: dict[CustomEvent, list[CustomEventTrigger]] = {}
    for item in context.all(CustomEventTrigger):
        if item.event is not None:
            found.setdefault(item.event, []).append(item)
    return found


def _callers(context: Context) -> dict[Runnable, list[RunnableCall]]:
    found: dict[Runnable, list[RunnableCall]] = {}
    for call in context.all(RunnableCall):
        if call.runnable is not None:
            found.setdefault(call.runnable, []).append(call)
    return found
