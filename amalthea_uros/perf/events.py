"""What can be observed, and the cause-effect chains from one event to another."""

from __future__ import annotations

from enum import StrEnum
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.named import Brief, Located, Named


class ProcessChange(StrEnum):
    """A transition of a process."""

    ACTIVATE = "activate"
    START = "start"
    RESUME = "resume"
    PREEMPT = "preempt"
    POLL = "poll"
    RUN = "run"
    WAIT = "wait"
    POLL_PARKING = "poll parking"
    PARK = "park"
    RELEASE_PARKING = "release parking"
    RELEASE = "release"
    TERMINATE = "terminate"


class RunnableChange(StrEnum):
    """A transition of a runnable."""

    START = "start"
    SUSPEND = "suspend"
    RESUME = "resume"
    TERMINATE = "terminate"


class LabelChange(StrEnum):
    """An access to a label."""

    READ = "read"
    WRITE = "write"


class ModeChange(StrEnum):
    """An access to a mode label."""

    READ = "read"
    WRITE = "write"
    INCREMENT = "increment"
    DECREMENT = "decrement"


class ChannelChange(StrEnum):
    """An access to a channel."""

    SEND = "send"
    RECEIVE = "receive"


class SemaphoreChange(StrEnum):
    """An access to a semaphore."""

    LOCK = "lock"
    UNLOCK = "unlock"


# Whatever is None in an event means "any".


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessEvent(Named):
    """A transition of a task or ISR."""

    process: str | None = None
    change: ProcessChange | None = None
    core: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class RunnableEvent(Named):
    """A transition of a runnable, in a process and on a core."""

    runnable: str | None = None
    change: RunnableChange | None = None
    process: str | None = None
    core: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class LabelEvent(Named):
    """An access to a label, by a runnable and in a process."""

    label: str | None = None
    change: LabelChange | None = None
    runnable: str | None = None
    process: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ModeLabelEvent(Named):
    """An access to a mode label."""

    label: str | None = None
    change: ModeChange | None = None
    runnable: str | None = None
    process: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ChannelEvent(Named):
    """An access to a channel."""

    channel: str | None = None
    change: ChannelChange | None = None
    runnable: str | None = None
    process: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class SemaphoreEvent(Named):
    """An access to a semaphore."""

    semaphore: str | None = None
    change: SemaphoreChange | None = None
    runnable: str | None = None
    process: str | None = None
    core: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class StimulusEvent(Named):
    """An occurrence of a stimulus."""

    stimulus: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class CustomEvent(Named):
    """Something that software raises, or that comes from outside."""

    kind: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class EventSet(Named):
    """Several events that all have to occur, in any order."""

    events: tuple[str, ...]


Event: TypeAlias = (
    ProcessEvent
    | RunnableEvent
    | LabelEvent
    | ModeLabelEvent
    | ChannelEvent
    | SemaphoreEvent
    | StimulusEvent
    | CustomEvent
    | EventSet
)


@dataclass(frozen=True, slots=True, kw_only=True)
class ChainReference:
    """A chain that is a part of another one."""

    chain: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Segment(Located):
    """A part of a chain that is described on the spot.

    Attributes
    ----------
    stimulus, response : names of events; None: not given
    """

    stimulus: str | None = None
    response: str | None = None
    items: Sequence | Parallel | None = None
    name: str = ""


ChainItem: TypeAlias = ChainReference | Segment


@dataclass(frozen=True, slots=True)
class Sequence:
    """Parts that follow each other: the response of one is the stimulus of the next."""

    items: tuple[ChainItem, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Parallel:
    """Parts side by side, of which a number has to complete: 1 for alternatives, all for a join."""

    items: tuple[ChainItem, ...]
    completed: int = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class EventChain(Named):
    """A cause-effect chain from its stimulus event to its response event; without items it is a single step."""

    stimulus: str | None = None
    response: str | None = None
    items: Sequence | Parallel | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Events(Brief):
    """All events of a system, and the chains between them."""

    events: tuple[Event, ...] = ()
    chains: tuple[EventChain, ...] = ()
