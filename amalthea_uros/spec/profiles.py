"""Profiles of middlewares as files: what is a number or a choice in a middleware, with its source."""

from __future__ import annotations

from amalthea_uros.spec.fields import entry
from amalthea_uros.spec.section import DescriptionSection
from amalthea_uros.spec.values import (
    Count,
    CountOrNone,
    Duration,
    Name,
    Offset,
    PayloadOrNothing,
    Priority,
    Size,
    VersionedSection,
)


class WaitingData(DescriptionSection):
    """How an executor waits for messages and timers."""

    messages_per_wait: Count | None = None
    """Most messages that a wait takes from the wire; if omitted, all that have arrived."""
    resolution: Offset = 0
    """The timeout is cut to whole multiples of it."""
    stored_data_ends_wait: bool = False
    """Whether messages that are stored already end the wait at once."""
    guard_conditions_end_wait: bool = False
    """Whether a guard condition ends the wait."""
    polls_without_messages: bool = True
    """Whether the wait of an executor that only has timers and guard conditions returns at once."""
    default_timeout: Duration = 10**12
    """Timeout of executors for which nobody set one."""


class SendingData(DescriptionSection):
    """How messages are sent."""

    waits: bool = True
    """Whether a reliable message keeps its sender until it is acknowledged."""
    flush_timeout: Duration | None = None
    """Time after which emptying full buffers times out, when a message is longer than all of them together."""
    replies_late: Offset = 0
    """By how much the wait for the reply to a ping can be longer than its timeout."""
    heartbeat: Duration | None = None
    """Least interval of messages of the other side that ask for acknowledgements."""
    holds_session_while_waiting: bool = False
    """Whether a thread that waits for messages keeps others from sending, with several threads."""
    drops_when_busy: bool = False
    """Whether a message is dropped when another thread is sending."""
    is_protected: bool = False
    """Whether several threads may use the middleware at the same time also where it is not built for that with `multithread`."""


class ThreadData(DescriptionSection):
    """A thread of the middleware, beside the executors."""

    name: Name
    """Name of its task."""
    does: str
    """What it does."""
    priority: Priority | None = None
    """Its priority; if omitted, it depends on the operating system, so that applications state it under `tasks`."""
    period: Duration | None = None
    """Period of its activation; if omitted, messages activate it."""
    stack: Size | None = None
    """Its stack."""
    calls_subscribers: bool = False
    """Whether callbacks of messages run in it, instead of in an executor."""


class ProfileData(VersionedSection):
    """A profile of a middleware: all of its figures, or those that differ from another profile."""

    profile: Name
    """Its name."""
    base: Name | None = None
    """The profile that holds for everything that is not stated here."""
    title: str = ""
    """Full name of the middleware."""
    source: str = ""
    """Where the figures come from."""
    sources: dict[Name, str] = entry(default_factory=dict)
    """Sources of single figures, by their keys."""
    waiting: WaitingData = entry(default_factory=WaitingData.model_construct)
    """How an executor waits."""
    sending: SendingData = entry(default_factory=SendingData.model_construct)
    """How messages are sent."""
    threads: list[ThreadData] = entry(default_factory=list)
    """Its threads."""
    sizes: dict[Name, PayloadOrNothing] = entry(default_factory=dict)
    """Sizes of headers and other parts of its messages."""
    options: dict[Name, CountOrNone] = entry(default_factory=dict)
    """Default values of build options where they differ from those of the packages, as the build takes them: lengths in bytes, times
    in milliseconds; `MTU` for that of the transport."""
