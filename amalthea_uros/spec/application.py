"""The application model: nodes with their subscriptions, publishers, timers, services and clients."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from amalthea_uros.spec.execution_time import ExecutionTime
from amalthea_uros.spec.section import Section
from amalthea_uros.spec.values import Duration, Name, Offset, Priority, Rate, Size

Reliability = Literal["reliable", "best-effort"]


class Callback(Section):
    """What all callbacks have."""

    name: Name
    """Name of the callback, and of its task."""
    execution_time: ExecutionTime
    """How long the callback executes."""
    reads: list[Name] = Field(default_factory=list)
    """Labels that it reads when it starts."""
    writes: list[Name] = Field(default_factory=list)
    """Labels that it writes when it ends."""
    publishes: list[Name] = Field(default_factory=list)
    """Topics of its node that it publishes to."""
    requests: list[Name] = Field(default_factory=list)
    """Clients of its node by which it sends a request."""
    runs_in: Literal["own-task", "executor"] | None = None
    """Where it runs; default: what the executor states."""
    task_period: Duration | None = None
    """Period of its task; default: the longest one on offer that the rules allow."""
    offset: Offset = 0
    """Time of the first activation of its task."""
    priority: Priority | None = None
    """Priority of its task; default: rate monotonic."""
    core: Name | None = None
    """Core of its task; default: that of its node."""
    deadline: Duration | None = None
    """Relative to the activation of its task."""


class MessageCallback(Callback):
    """A callback that a message makes ready."""

    rate: Rate | None = None
    """How often messages come at most."""
    interval: Duration | None = None
    """Least time between two messages; the same as `rate`, said the other way round."""
    buffer: Name | None = None
    """Label by which the executor hands the message over; default: the name with `_message`."""


class Subscription(MessageCallback):
    """A subscription with its callback."""

    topic: Name
    """What it subscribes to."""
    message_size: Size
    """Size of a message, without headers."""
    reliability: Reliability = "reliable"
    """Quality of service."""


class Timer(Callback):
    """A timer with its callback."""

    period: Duration | None = None
    """Period of the timer."""
    rate: Rate | None = None
    """The same, said the other way round."""


class Publisher(Section):
    """A publisher, by which callbacks of the node send messages."""

    topic: Name
    """What it publishes to."""
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
    """A service client; its callback gets the responses."""

    service: Name
    """The service that it asks."""
    request_size: Size
    """Size of a request, without headers."""
    response_size: Size
    """Size of a response, without headers."""


class Node(Section):
    """A node."""

    name: Name
    """Name of the node."""
    core: Name | None = None
    """Core of its callbacks; default: the first one."""
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
