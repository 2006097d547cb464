"""What processes do that others notice, and what depends on what others do."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from amalthea_uros.metamodel.classes import (
    ChannelFillCondition,
    ChannelFillRef,
    ChannelReceive,
    ChannelSend,
    IExecutable,
    InterProcessTrigger,
    LabelAccess,
    LabelAccessEnum,
    ModeLabelAccess,
    ModeLabelAccessEnum,
    ModeLabelAssignment,
    ModeLabelCondition,
    ModeLabelRef,
    ModeValueCondition,
    OsEvent,
    Process,
    Runnable,
    SenderReceiverRead,
    SenderReceiverWrite,
    ServerCall,
    SetEvent,
    Stimulus,
    WaitEvent,
)
from amalthea_uros.metamodel.element import Element


@dataclass(slots=True)
class Deeds:
    """What a process or runnable does.

    Attributes
    ----------
    signalled : events of the operating system, and for whom they are set; None: for all
    served : runnables that it calls as a client
    """

    written: set[Element] = field(default_factory=set)
    read: set[Element] = field(default_factory=set)
    triggered: set[Stimulus] = field(default_factory=set)
    signalled: set[tuple[OsEvent, Process | None]] = field(default_factory=set)
    awaited: set[OsEvent] = field(default_factory=set)
    served: set[Runnable] = field(default_factory=set)

    @classmethod
    def of(cls, executable: IExecutable) -> Deeds:
        """Those of a process or runnable itself, without those of the runnables that it calls."""
        found = cls()
        for item in executable.walk():
            if isinstance(item, _KINDS):
                found.written.update(written(item))
                found.read.update(read(item))
                found._note(item)
        return found

    def _note(self, item: Element) -> None:
        match item:
            case InterProcessTrigger(stimulus=Stimulus() as stimulus):
                self.triggered.add(stimulus)
            case SetEvent() if item.event_mask is not None:
                self.signalled.update((event, item.process) for event in item.event_mask.events)
            case WaitEvent() if item.event_mask is not None:
                self.awaited.update(item.event_mask.events)
            case ServerCall(server_runnable=Runnable() as runnable):
                self.served.add(runnable)

    def add(self, other: Deeds) -> None:
        """Take over what another one does."""
        self.written |= other.written
        self.read |= other.read
        self.triggered |= other.triggered
        self.signalled |= other.signalled
        self.awaited |= other.awaited
        self.served |= other.served


#: What is a deed, or may depend on one.
_KINDS = (
    LabelAccess,
    ModeLabelAccess,
    ChannelSend,
    ChannelReceive,
    SenderReceiverRead,
    SenderReceiverWrite,
    ModeLabelAssignment,
    ModeLabelRef,
    ModeValueCondition,
    ModeLabelCondition,
    ChannelFillCondition,
    ChannelFillRef,
    InterProcessTrigger,
    SetEvent,
    WaitEvent,
    ServerCall,
)


def written(item: Element | None) -> Iterable[Element]:
    """The labels, mode labels and channels that an item writes."""
    match item:
        case LabelAccess(access=LabelAccessEnum.WRITE, data=Element() as data) | ChannelSend(data=Element() as data):
            return (data,)
        case ModeLabelAccess(access=access, data=Element() as data) if access is not ModeLabelAccessEnum.READ:
            return (data,)
        case SenderReceiverWrite(label=Element() as data) | ModeLabelAssignment(global_label=Element() as data):
            return (data,)
    return ()


def read(item: Element | None) -> Iterable[Element]:
    """The labels, mode labels and channels that an item reads, or on which a condition depends."""
    match item:
        case LabelAccess(access=LabelAccessEnum.READ, data=Element() as data) | ChannelReceive(data=Element() as data):
            return (data,)
        case SenderReceiverRead(label=Element() as data) | ModeLabelAssignment(global_label=Element() as data):
            return (data,)
        # Steps depend on the value before them.
        case ModeLabelAccess(data=Element() as data) | ModeLabelRef(value=Element() as data):
            return (data,)
        case ModeValueCondition(label=Element() as data) | ChannelFillCondition(channel=Element() as data):
            return (data,)
        case ChannelFillRef(value=Element() as data):
            return (data,)
        case ModeLabelCondition():
            return tuple(label for label in (item.label1, item.label2) if label is not None)
    return ()
