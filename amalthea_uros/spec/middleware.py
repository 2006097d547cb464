"""The generic micro-ROS model: executors, transport and limits of the middleware, as ported to a platform."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from amalthea_uros.spec.executors import Executor, MessageCost
from amalthea_uros.spec.section import Section, Shorthand
from amalthea_uros.spec.transports import Agent, Transport
from amalthea_uros.spec.values import Count, CountOrNone, Duration, Name, Priority, Size, described


class ResponseTime(Shorthand):
    """Time from a request to the agent to its response: a time, or a mapping with minimum and maximum."""

    shorthand = (
        "min",
        "max",
    )
    plain_value = "The same response time for every request."

    min: Duration
    """Minimum time."""
    max: Duration
    """Maximum time."""


class Initialisation(Section):
    """Creation of the entities, one after the other."""

    response_time: ResponseTime | None = None
    """Response time of the agent; if omitted, only the minimum number of cycles is known."""


class PoolSizes(Section):
    """Static pools of rmw_microxrcedds, by the names of its build options."""

    RMW_UXRCE_MAX_SESSIONS: Count | None = None
    """Sessions with an agent."""
    RMW_UXRCE_MAX_NODES: Count | None = None
    """Nodes."""
    RMW_UXRCE_MAX_TOPICS: Annotated[int, Field(strict=True, ge=-1)] | None = None
    """Topics; -1: as many as there are publishers, subscriptions, services and clients."""
    RMW_UXRCE_MAX_PUBLISHERS: CountOrNone | None = None
    """Publishers."""
    RMW_UXRCE_MAX_SUBSCRIPTIONS: CountOrNone | None = None
    """Subscriptions."""
    RMW_UXRCE_MAX_SERVICES: CountOrNone | None = None
    """Service servers."""
    RMW_UXRCE_MAX_CLIENTS: CountOrNone | None = None
    """Service clients."""
    RMW_UXRCE_MAX_HISTORY: Count | None = None
    """Messages that are kept for all subscriptions, services and clients together."""
    RMW_UXRCE_MTU: Size | None = None
    """Maximum size of a message of the transport."""
    RMW_UXRCE_STREAM_HISTORY: Count | None = None
    """MTU-sized buffers of a reliable stream."""


_POLICIES = described(
    FixedPriorityPreemptive="The ready task with the highest priority executes.",
    OSEK="As `FixedPriorityPreemptive`, with the task types and the priority ceiling protocol of OSEK.",
)


class Reliable(Section):
    """How reliable messages are sent."""

    waits: bool = True
    """Whether a publishing callback waits until the agent has acknowledged its message; `false` for ports that do not."""
    timeout: Duration | None = None
    """Time after which it gives up; default: that of the middleware, `RMW_UXRCE_PUBLISH_RELIABLE_TIMEOUT` for XRCE-DDS."""


class MiddlewareTask(Section):
    """A task or thread of the middleware, beside the executors."""

    name: Name
    """Name of the task, as the middleware calls it: see `amuros explain` of its profile."""
    priority: Priority | None = None
    """Its priority; default: that of the profile."""
    core: Name | None = None
    """Its core; default: that of the first executor."""
    execution_time: MessageCost | None = None
    """Execution time per message."""
    stack: Size | None = None
    """Its stack."""


class Middleware(Section):
    """The generic micro-ROS model of a platform."""

    profile: Name = "xrce-dds"
    """The middleware: `xrce-dds`, `zenoh-pico`, or a file that describes another one."""
    policy: Annotated[Literal["FixedPriorityPreemptive", "OSEK"], _POLICIES] = "FixedPriorityPreemptive"
    """Scheduling policy of the operating system."""
    task_periods: list[Duration] = Field(default_factory=list)
    """Available task periods; if omitted, any period is available."""
    executor: Executor = Field(default_factory=Executor)
    """The executor, if there is only one."""
    executors: list[Executor] = Field(default_factory=list)
    """The executors, if there are several; the first one serves callbacks that name no other."""
    multithread: bool = False
    """Whether the middleware is built for several threads: then they share its session, one at a time."""
    publish: MessageCost = Field(default_factory=MessageCost)
    """Execution time of publishing a message, added to that of the callback."""
    reliable: Reliable = Field(default_factory=Reliable)
    """How reliable messages are sent."""
    tasks: list[MiddlewareTask] = Field(default_factory=list)
    """Tasks or threads of the middleware."""
    transport: Transport = Field(default_factory=Transport)
    """The transport to the agent."""
    agent: Agent = Field(default_factory=Agent)
    """The agent, or the router of the middleware."""
    initialisation: Initialisation = Field(default_factory=Initialisation)
    """Creation of the entities."""
    limits: PoolSizes = Field(default_factory=PoolSizes)
    """Static pools."""
