"""The application model: nodes with their subscriptions, publishers, timers, services and clients."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from amalthea_uros.spec.execution_time import ExecutionTime
from amalthea_uros.spec.os import Overhead
from amalthea_uros.spec.section import Section
from amalthea_uros.spec.values import Duration, Name, Offset, Priority, Rate, Size, described

Reliability = Annotated[
    Literal["reliable", "best-effort"],
    described(
        reliable="Messages are acknowledged, and sent again until they are.",
        best_effort="Messages are sent once, without acknowledgement.",
    ),
]


_PLACES = described(own_task="In a separate task.", executor="In the task of the executor.")
_CONDITIONS = described(
    activated="In every activation of its task.",
    due="Only in the activations of its task in which it is due.",
)


class Callback(Section):
    """Keys that all callbacks have."""

    name: Name
    """Name of the callback, and of its task."""
    execution_time: ExecutionTime
    """Execution time of the callback."""
    reads: list[Name] = Field(default_factory=list)
    """Labels that it reads at its start."""
    writes: list[Name] = Field(default_factory=list)
    """Labels that it writes at its end."""
    publishes: list[Name] = Field(default_factory=list)
    """Topics of its node that it publishes to."""
    requests: list[Name] = Field(default_factory=list)
    """Clients of its node that it sends requests with."""
    runs_in: Annotated[Literal["own-task", "executor"], _PLACES] | None = None
    """Where it runs; default: `callbacks` of the executor."""
    task_period: Duration | None = None
    """Period of its task; default: the longest available period that the rules allow."""
    runs_when: Annotated[Literal["activated", "due"], _CONDITIONS] | None = None
    """In which activations of its task it runs, if that is activated more often than the callback is due: in all of them, or only in
    every n-th; default: `activated` for callbacks of messages, which then use the latest message, and `due` for timers."""
    phase: Offset | None = None
    """Activation of the executor in which it is due for the first time, e.g. when the first message is taken; default: unknown, so that
    all phases are analysed."""
    offset: Offset = 0
    """Time of the first activation of its task."""
    priority: Priority | None = None
    """Priority of its task; default: rate monotonic."""
    core: Name | None = None
    """Core of its task; default: the core of its node."""
    deadline: Duration | None = None
    """Deadline relative to the activation of its task."""
    overhead: Overhead | None = None
    """Overhead of the operating system per job of its task; default: that of `os`."""


class MessageCallback(Callback):
    """A callback that becomes ready when a message arrives."""

    rate: Rate | None = None
    """Maximum rate of messages."""
    interval: Duration | None = None
    """Minimum time between two messages; the reciprocal of `rate`."""
    buffer: Name | None = None
    """Label in which the executor passes the message on; default: the name followed by `_message`."""


class Subscription(MessageCallback):
    """A subscription with its callback."""

    topic: Name
    """Topic that it subscribes to."""
    message_size: Size
    """Size of a message, without headers."""
    jitter: Duration | None = None
    """Maximum delay of a message against its nominal time, shorter than `interval`; default: messages arrive regularly."""
    reliability: Reliability = "reliable"
    """Quality of service."""


class Timer(Callback):
    """A timer with its callback."""

    period: Duration | None = None
    """Period of the timer."""
    rate: Rate | None = None
    """Rate of the timer; the reciprocal of `period`."""


class Publisher(Section):
    """A publisher that callbacks of the node send messages with."""

    topic: Name
    """Topic that it publishes to."""
    message_size: Size
    """Size of a message, without headers."""
    reliability: Reliability = "reliable"
    """Quality of service."""


class Service(MessageCallback):
    """A service server; its callback answers requests."""

    request_size: Size
    """Size of a request, without headers."""
    response_size: Size
    """Size of a response, without headers."""


class Client(MessageCallback):
    """A service client; its callback receives the responses."""

    service: Name
    """Service that it sends requests to."""
    request_size: Size
    """Size of a request, without headers."""
    response_size: Size
    """Size of a response, without headers."""


class Node(Section):
    """A node."""

    name: Name
    """Name of the node."""
    core: Name | None = None
    """Core of its callbacks; default: the first core."""
    subscriptions: list[Subscription] = Field(default_factory=list)
    """Its subscriptions."""
    publishers: list[Publisher] = Field(default_factory=list)
    """Its publishers."""
    timers: list[Timer] = Field(default_factory=list)
    """Its timers."""
    services: list[Service] = Field(default_factory=list)
    """Its service servers."""
    clients: list[Client] = Field(default_factory=list)
    """Its service clients."""


class Application(Section):
    """The micro-ROS application."""

    nodes: list[Node] = Field(default_factory=list)
    """Its nodes."""
