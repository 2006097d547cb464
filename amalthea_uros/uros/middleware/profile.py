"""What the model, the checks and the pools ask of a middleware.

Each middleware has a profile. Its numbers and choices are in `profile.yaml`, with their sources; its rules are code in the same
folder. A user's profile is a file that names the profile that it changes (`base`), and the values that differ.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from typing import NamedTuple, Self

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.perf.executors import WaitBehaviour
from amalthea_uros.perf.named import Brief
from amalthea_uros.perf.network import Direction, Recovery
from amalthea_uros.spec.application import Application
from amalthea_uros.spec.middleware import Middleware, MiddlewareTask, PoolSizes
from amalthea_uros.spec.profiles import ProfileData, ThreadData
from amalthea_uros.units import DataSize, Time
from amalthea_uros.uros.application.messages import MessageKind
from amalthea_uros.uros.middleware.options import Option, OptionRow


@dataclass(frozen=True, slots=True, kw_only=True)
class MessagePart(Brief):
    """A message of the middleware on the wire: a whole one, or a fragment of one that is too long.

    Attributes
    ----------
    length : in bytes with the headers of the middleware, without the framing of the transport
    acknowledgement : length of what the receiver answers to it; None for nothing
    """

    length: int
    acknowledgement: int | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class MemoryUse(Brief):
    """Bytes of memory that something of the middleware occupies.

    Attributes
    ----------
    size : the least, if it is not bounded
    formula : how it is computed, with the values; why it is not bounded
    """

    name: str
    size: int
    formula: str
    is_bounded: bool = True


@dataclass(frozen=True, slots=True, kw_only=True)
class MiddlewareThread(Brief):
    """A thread of the middleware.

    Attributes
    ----------
    priority : None if it depends on the operating system, and the description does not state it
    period : None if messages activate it
    stack : in bytes; None if it is not known
    calls_subscribers : whether callbacks of messages run in it, instead of in an executor
    """

    name: str
    priority: int | None
    period: Time | None
    stack: int | None
    calls_subscribers: bool
    does: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Sending(Brief):
    """How the middleware sends.

    Attributes
    ----------
    waits : whether a reliable message keeps its sender until it is acknowledged
    timeout : after which the sender gives up
    resends_after : time without an acknowledgement after which the receiver is asked for it; None if the transport cares for losses
    holds_session_while_waiting : whether a thread that waits for messages keeps others from sending, with several threads
    drops_when_busy : whether a message is dropped when another thread is sending
    is_protected : whether several threads may use the middleware at the same time
    """

    waits: bool
    timeout: Time
    resends_after: Time | None
    holds_session_while_waiting: bool
    drops_when_busy: bool
    is_protected: bool


class CreationFigures(NamedTuple):
    """The messages that create entities, in bytes without the framing of the transport, and the limits of their responses.

    Attributes
    ----------
    least_request : the shortest request for an entity, whatever its names are
    status : the response to it
    data_request : by which a receiving entity asks for its data
    acknowledgement : of each of them; None if they are not reliable
    session_limit, entity_limit : time after which the creation has failed; 0 for entities that are not waited for
    """

    session_request: int
    session_response: int
    least_request: int
    status: int
    data_request: int
    acknowledgement: int | None
    session_limit: Time
    entity_limit: Time


class Heartbeat(NamedTuple):
    """A message that the middleware sends by itself.

    Attributes
    ----------
    length : in bytes, without the framing of the transport
    interval : the least one
    is_answered : whether it asks for acknowledgements, while something is not acknowledged; else it keeps the connection alive
    """

    length: int
    interval: Time
    is_answered: bool


@dataclass(frozen=True, slots=True)
class Profile(ABC):
    """A middleware with the settings of a description; sizes are in bytes, and `content` is the serialised message without headers.

    Attributes
    ----------
    data : its figures
    """

    data: ProfileData
    middleware: Middleware

    def configured(self, middleware: Middleware) -> Self:
        """The same middleware with other settings."""
        return replace(self, middleware=middleware)

    def with_options(self, values: Mapping[str, int]) -> Self:
        """The same middleware with other values of build options, as far as a description can state them."""
        stated = {
            name: self.option_table[name].described(value) for name, value in values.items() if name in PoolSizes.model_fields
        }
        limits = self.middleware.limits.model_copy(update=stated)
        return self.configured(self.middleware.model_copy(update={"limits": limits}))

    @property
    def name(self) -> str:
        """Its name."""
        return self.data.profile

    @property
    def title(self) -> str:
        """Its full name."""
        return self.data.title

    @property
    def source(self) -> str:
        """Where its figures come from."""
        return self.data.source

    def size(self, name: str) -> int:
        """A figure of the profile, rounded up to bytes."""
        return whole_bytes(self.data.sizes[name])

    @property
    def waiting(self) -> WaitBehaviour:
        """How an executor waits."""
        figures = self.data.waiting
        return WaitBehaviour(
            messages_per_wait=figures.messages_per_wait,
            resolution=figures.resolution,
            stored_data_ends_wait=figures.stored_data_ends_wait,
            guard_conditions_end_wait=figures.guard_conditions_end_wait,
            polls_without_messages=figures.polls_without_messages,
            slots=self.slots,
            default_timeout=figures.default_timeout,
        )

    @property
    def replies_to_pings(self) -> bool:
        """Whether the other side replies to pings, and to questions for its time."""
        return "ping" in self.data.sizes

    @property
    def replies_late(self) -> Time:
        """By how much the wait for such a reply can be longer than its timeout."""
        return self.data.sending.replies_late

    @property
    def threads(self) -> tuple[MiddlewareThread, ...]:
        """Its threads beside the executors: those of the profile, then those that only the description knows."""
        tasks = {task.name: task for task in self.middleware.tasks}
        known = [_thread(thread, tasks.pop(thread.name, None)) for thread in self.data.threads]
        return (*known, *(_thread(ThreadData(name=task.name, does="receives messages"), task) for task in tasks.values()))

    @property
    def slots(self) -> int | None:
        """The number of messages that can be stored for all handles together; None for no limit."""
        return None

    @property
    def slot_size(self) -> int | None:
        """Bytes of memory that each of these slots takes; None without slots."""
        return None

    @property
    @abstractmethod
    def sending(self) -> Sending:
        """How messages are sent."""

    @abstractmethod
    def heartbeat(self, direction: Direction) -> Heartbeat:
        """What it sends by itself in a direction."""

    @property
    def creation(self) -> CreationFigures | None:
        """How entities are created; None if the agent does not create them on request."""
        return None

    @property
    def recovery(self) -> Recovery | None:
        """How reliable messages that were lost are sent again; None if it leaves that to the transport."""
        return None

    @property
    def buffers(self) -> int | None:
        """The number of buffers in which reliable messages wait for their acknowledgement, a part in each; None for no limit."""
        return None

    @property
    @abstractmethod
    def option_table(self) -> Mapping[str, OptionRow]:
        """What is known of its build options, by name."""

    @abstractmethod
    def parts(self, kind: MessageKind, content: int, *, reliable: bool) -> Sequence[MessagePart]:
        """What is sent for a message: one part, or fragments; one that cannot be sent is a single part, longer than allowed."""

    @abstractmethod
    def times_out_after(self, kind: MessageKind, content: int, *, reliable: bool) -> Time | None:
        """Time after which the sender of a message stops waiting for its acknowledgement; None if it does not wait."""

    @abstractmethod
    def largest_content(self, kind: MessageKind, *, reliable: bool) -> int | None:
        """The longest content that can be sent or received; None for no limit."""

    @abstractmethod
    def limiting_options(self, *, reliable: bool) -> Sequence[str]:
        """The build options that limit the content of messages."""

    @abstractmethod
    def options(self, application: Application) -> Sequence[Option]:
        """Its build options, with what the application needs."""

    @abstractmethod
    def memory(self, application: Application) -> Sequence[MemoryUse]:
        """What it occupies with the options of the description."""


def _thread(data: ThreadData, task: MiddlewareTask | None) -> MiddlewareThread:
    """A thread with what the description says about it."""
    priority = data.priority if task is None or task.priority is None else task.priority
    stack = data.stack if task is None or task.stack is None else task.stack
    return MiddlewareThread(
        name=data.name,
        priority=priority,
        period=data.period,
        stack=None if stack is None else whole_bytes(stack),
        calls_subscribers=data.calls_subscribers,
        does=data.does,
    )


def whole_bytes(bits: DataSize) -> int:
    """A size in bytes, rounded up."""
    return -(-bits // 8)
