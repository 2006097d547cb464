"""What the model, the checks and the pools ask of a middleware.

Each middleware has a profile. Its numbers and choices are in `profile.yaml`, with their sources; its rules are code in the same
folder. A user's profile is a file that names the profile that it changes (`base`), and the values that differ.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, NamedTuple, Protocol

from amalthea_uros.perf.executors import Waiting
from amalthea_uros.perf.named import Brief
from amalthea_uros.spec.application import Application
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.uros.middleware.options import OptionRow


class MessageKind(StrEnum):
    """What a message of the middleware carries."""

    PUBLICATION = "publication"
    DELIVERY = "delivery"
    REQUEST_OUT = "request to a service elsewhere"
    REQUEST_IN = "request to a service here"
    RESPONSE_OUT = "response of a service here"
    RESPONSE_IN = "response of a service elsewhere"


@dataclass(frozen=True, slots=True, kw_only=True)
class Part(Brief):
    """A message of the middleware on the wire: a whole one, or a fragment of one that is too long.

    Attributes
    ----------
    length : in bytes with the headers of the middleware, without the framing of the transport
    acknowledgement : length of what the receiver answers to it; None for nothing
    """

    length: int
    acknowledgement: int | None = None


class OptionRole(StrEnum):
    """What depends on the value of a build option."""

    POOL = "pool"  # how many things can be created
    QUEUE = "queue"  # how many messages can wait; more of them are lost
    ROOM = "room"  # how long a name can be
    SETTING = "setting"  # times and sizes that the figures depend on


@dataclass(frozen=True, slots=True, kw_only=True)
class Option(Brief):
    """A build option of the middleware.

    Attributes
    ----------
    package : the package whose build takes it, for `colcon.meta`
    needed : smallest value with which the application works, a lower bound for a queue; None if it has no use for it
    available : the value that the description states, or else the default
    is_stated : whether the description states it
    unit : such as "B" or "ms"; "" for a number of things
    counts : what it counts, for a comment
    when_exhausted : what happens when the application needs more
    least : smallest value that the build takes
    is_power_of_two : whether the build takes powers of two only
    words : values that are words, by their numbers; () if they are numbers
    without_effect : why the value that is stated has no effect; "" if it has
    """

    name: str
    package: str
    needed: int | None
    available: int
    is_stated: bool
    role: OptionRole = OptionRole.POOL
    unit: str = ""
    counts: str = ""
    when_exhausted: str = ""
    least: int = 0
    is_power_of_two: bool = False
    words: tuple[str, ...] = ()
    without_effect: str = ""

    @property
    def is_exceeded(self) -> bool:
        """Whether the application needs more than there is, or something else."""
        if self.needed is None:
            return False
        return self.needed != self.available if self.words else self.needed > self.available

    @property
    def smallest(self) -> int | None:
        """The smallest value that the build takes and with which the application works; None if it has no use for it."""
        if self.needed is None:
            return None
        value = max(self.needed, self.least)
        return 1 << (value - 1).bit_length() if self.is_power_of_two else value

    def text(self, value: int) -> str:
        """A value as the build takes it."""
        return self.words[value] if self.words else str(value)


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


class Profile(Protocol):
    """A middleware; sizes are in bytes, and `content` is the serialised message without headers."""

    @property
    def name(self) -> str:
        """Its name."""
        ...

    @property
    def title(self) -> str:
        """Its full name."""
        ...

    @property
    def source(self) -> str:
        """Where its figures come from."""
        ...

    def waiting(self, middleware: Middleware) -> Waiting:
        """How an executor waits."""
        ...

    def sending(self, middleware: Middleware) -> Sending:
        """How messages are sent."""
        ...

    def threads(self, middleware: Middleware) -> Sequence[MiddlewareThread]:
        """Its threads beside the executors."""
        ...

    def parts(self, kind: MessageKind, content: int, *, reliable: bool, middleware: Middleware) -> Sequence[Part]:
        """What is sent for a message: one part, or fragments."""
        ...

    def heartbeat(self, middleware: Middleware) -> Heartbeat | None:
        """What it sends by itself, in both directions; None for nothing."""
        ...

    def gives_up_after(self, kind: MessageKind, content: int, *, reliable: bool, middleware: Middleware) -> Time | None:
        """Time after which the sender of a message stops waiting for its acknowledgement; None if it does not wait."""
        ...

    def largest_content(self, kind: MessageKind, *, reliable: bool, middleware: Middleware) -> int | None:
        """The longest content that can be sent or received; None for no limit."""
        ...

    def limiting_options(self, *, reliable: bool, middleware: Middleware) -> Sequence[str]:
        """The build options that limit the content of messages."""
        ...

    def buffers(self, middleware: Middleware) -> int | None:
        """The number of buffers in which reliable messages wait for their acknowledgement, a part in each; None for no limit."""
        ...

    def option_table(self) -> Mapping[str, OptionRow]:
        """What is known of its build options, by name."""
        ...

    def options(self, application: Application, middleware: Middleware) -> Sequence[Option]:
        """Its build options, with what the application needs."""
        ...

    def memory(self, application: Application, middleware: Middleware) -> Sequence[MemoryUse]:
        """What it occupies with the options of the description."""
        ...
