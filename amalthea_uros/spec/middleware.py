"""The generic micro-ROS model: the executor, the transport and the limits of the middleware, as they were ported to a platform."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from amalthea_uros.spec.execution_time import ExecutionTime
from amalthea_uros.spec.section import Section, Shorthand
from amalthea_uros.spec.values import BitRate, Count, CountOrNone, Duration, Name, Offset, Priority, Size, SizeOrNothing


class MessageCost(Shorthand):
    """What a message costs: a time, or a fixed part and a part per byte."""

    shorthand = ("fixed",)
    nested = ExecutionTime

    fixed: ExecutionTime | None = None
    """The part that each message costs."""
    per_byte: Offset = 0
    """The part that each byte of the message costs."""


class ExecutorCost(Shorthand):
    """What an activation of the executor costs: a time, or parts that depend on what there is to do."""

    shorthand = ("base",)
    nested = ExecutionTime

    base: ExecutionTime | None = None
    """What every activation costs."""
    per_ready_callback: ExecutionTime | None = None
    """What each callback costs that is ready."""
    per_message: MessageCost = Field(default_factory=MessageCost)
    """What each message costs that is taken."""
    per_timer: ExecutionTime | None = None
    """What each timer costs that is looked at, in every activation."""


class Trigger(Shorthand):
    """When the executor runs its callbacks: `any`, `all`, or `{one: NAME}`."""

    shorthand = ("when",)

    when: Literal["any", "all"] = "any"
    """As soon as any callback is ready, or not before all are."""
    one: Name | None = None
    """As soon as this callback is ready."""


class Executor(Section):
    """The task that serves the middleware and notifies or runs callbacks."""

    name: Name = "Executor_Task"
    """Name of the task."""
    period: Duration | None = None
    """Default: the longest period on offer that no callback is faster than."""
    offset: Offset = 0
    """Time of the first activation."""
    priority: Priority | None = None
    """Default: rate monotonic, before all other tasks of the same period."""
    core: Name | None = None
    """Default: the first core."""
    deadline: Duration | None = None
    """Relative to the activation."""
    execution_time: ExecutorCost = Field(default_factory=ExecutorCost)
    """What an activation costs."""
    callbacks: Literal["own-task", "in-executor"] = "own-task"
    """Where callbacks run that do not state it: each in a task of its own, or in the executor one after the other."""
    order: list[Name] = Field(default_factory=list)
    """Order in which callbacks were added to the executor; those not named follow as they stand in the file."""
    semantics: Literal["ROS", "LET"] = "ROS"
    """Each message is taken just before its callback (ROS), or all are taken first (LET)."""
    trigger: Trigger = Field(default_factory=Trigger)
    """Condition under which callbacks in the executor run."""


class Interrupt(Shorthand):
    """The interrupt service routine that receives a frame: its execution time, or a mapping with more."""

    name: Name = "CAN_Receive"
    """Name of the interrupt service routine."""
    execution_time: ExecutionTime
    """What a frame costs."""
    priority: Priority = 1
    """Priority among interrupt service routines."""
    core: Name | None = None
    """Default: that of the executor."""

    shorthand = ("execution_time",)
    nested = ExecutionTime


class Can(Section):
    """XRCE-DDS over CAN: blocks of 7 bytes behind a header byte."""

    bitrate: BitRate
    """Bit rate of the bus."""
    identifier: Literal["standard", "extended"] = "standard"
    """Identifiers of 11 or of 29 bits."""
    interrupt: Interrupt | None = None
    """The interrupt of each received frame; left out: it is part of other execution times."""


class Transport(Section):
    """The way of messages between the controller and the agent."""

    can: Can | None = None
    """The CAN bus, where that is the way."""
    overhead: SizeOrNothing = 12 * 8
    """What XRCE-DDS adds to a message: message header, submessage header and object ids; default 12 B."""
    acknowledgement: Duration | None = None
    """Most time until a reliable message is acknowledged."""


class ResponseTime(Shorthand):
    """Least and most time from a request to the agent until its response."""

    shorthand = (
        "min",
        "max",
    )

    min: Duration
    """Least time."""
    max: Duration
    """Most time."""


class Initialisation(Section):
    """Creation of the entities, one after the other."""

    response_time: ResponseTime | None = None
    """How long the agent takes for an answer; left out: only the least number of cycles is known."""


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
    RMW_UXRCE_MTU: Size | None = None
    """Most bytes of a message of the transport."""
    RMW_UXRCE_STREAM_HISTORY: Count | None = None
    """MTU-sized buffers of a reliable stream."""


class Middleware(Section):
    """The generic micro-ROS model of a platform."""

    policy: Literal["FixedPriorityPreemptive", "OSEK"] = "FixedPriorityPreemptive"
    """Scheduling policy of the operating system."""
    task_periods: list[Duration] = Field(default_factory=list)
    """Task periods on offer; left out: every period is."""
    executor: Executor = Field(default_factory=Executor)
    """The executor."""
    publish: MessageCost = Field(default_factory=MessageCost)
    """What it costs a callback to publish a message."""
    transport: Transport = Field(default_factory=Transport)
    """The way to the agent."""
    initialisation: Initialisation = Field(default_factory=Initialisation)
    """Creation of the entities."""
    limits: PoolSizes = Field(default_factory=PoolSizes)
    """Static pools."""
