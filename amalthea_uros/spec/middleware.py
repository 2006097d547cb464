"""The generic micro-ROS model: executor, transport and limits of the middleware, as ported to a platform."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from amalthea_uros.spec.execution_time import ExecutionTime
from amalthea_uros.spec.os import Overhead
from amalthea_uros.spec.section import Section, Shorthand
from amalthea_uros.spec.values import (
    BitRate,
    CanIdentifier,
    Count,
    CountOrNone,
    Duration,
    Name,
    Offset,
    Priority,
    Size,
    SizeOrNothing,
    described,
)


class MessageCost(Shorthand):
    """Execution time per message: a time, or a fixed part and a part per byte."""

    shorthand = ("fixed",)
    plain_value = "The same execution time for every message."
    nested = ExecutionTime

    fixed: ExecutionTime | None = None
    """Execution time per message, independent of its size."""
    per_byte: Offset = 0
    """Additional execution time per byte of the message."""


class ExecutorCost(Shorthand):
    """Execution time of an activation of the executor: a time, or parts that depend on the callbacks and messages to serve."""

    shorthand = ("base",)
    plain_value = "The same execution time in every activation of the executor."
    nested = ExecutionTime

    base: ExecutionTime | None = None
    """Execution time of every activation."""
    per_ready_callback: ExecutionTime | None = None
    """Additional execution time per ready callback."""
    per_message: MessageCost = Field(default_factory=MessageCost)
    """Additional execution time per message taken."""
    per_timer: ExecutionTime | None = None
    """Additional execution time per timer, in every activation."""


_TRIGGERS = described(any="As soon as any callback is ready.", all="When all callbacks are ready.")


class Trigger(Shorthand):
    """When the executor runs its callbacks: `any`, `all`, or `{one: NAME}`."""

    shorthand = ("when",)
    plain_value = "`any`: as soon as any callback is ready; `all`: when all callbacks are ready."

    when: Annotated[Literal["any", "all"], _TRIGGERS] = "any"
    """`any`: as soon as any callback is ready; `all`: when all callbacks are ready."""
    one: Name | None = None
    """As soon as this callback is ready."""


_PLACES = described(
    own_task="Each callback in a separate task.",
    in_executor="One after the other in the task of the executor.",
)
_SEMANTICS = described(
    ROS="Each message is taken just before its callback runs.",
    LET="All messages are taken before the first callback runs (logical execution time).",
)


class Executor(Section):
    """The task that serves the middleware and notifies or runs callbacks."""

    name: Name = "Executor_Task"
    """Name of the task."""
    period: Duration | None = None
    """Period of its activation; default: the longest available period that is not longer than the interval of any callback."""
    offset: Offset = 0
    """Time of the first activation."""
    priority: Priority | None = None
    """Priority of its task; default: rate monotonic, above all other tasks with the same period."""
    core: Name | None = None
    """Core of its task; default: the first core."""
    deadline: Duration | None = None
    """Deadline relative to the activation."""
    overhead: Overhead | None = None
    """Overhead of the operating system per job; default: that of `os`."""
    execution_time: ExecutorCost = Field(default_factory=ExecutorCost)
    """Execution time of an activation."""
    callbacks: Annotated[Literal["own-task", "in-executor"], _PLACES] = "own-task"
    """Where callbacks without `runs_in` run: each in a separate task, or one after the other in the executor."""
    order: list[Name] = Field(default_factory=list)
    """Order in which callbacks were added to the executor; callbacks not listed follow in the order of the file."""
    semantics: Annotated[Literal["ROS", "LET"], _SEMANTICS] = "ROS"
    """`ROS`: each message is taken just before its callback runs; `LET`: all messages are taken before the first callback runs."""
    trigger: Trigger = Field(default_factory=Trigger)
    """Condition under which callbacks in the executor run."""


class Interrupt(Shorthand):
    """The interrupt service routine that receives a frame: its execution time, or a mapping with more."""

    name: Name = "CAN_Receive"
    """Name of the interrupt service routine."""
    execution_time: ExecutionTime
    """Execution time per frame."""
    priority: Priority = 1
    """Priority among interrupt service routines."""
    core: Name | None = None
    """Core that it runs on; default: the core of the executor."""
    overhead: Overhead | None = None
    """Overhead of the operating system per job; default: that of `os`."""

    shorthand = ("execution_time",)
    plain_value = "Execution time per frame."
    nested = ExecutionTime


_FRAME_FORMATS = described(standard="Identifiers of 11 bits.", extended="Identifiers of 29 bits.")


class Can(Section):
    """XRCE-DDS over CAN: frames of a header byte and up to 7 bytes of data."""

    bitrate: BitRate
    """Bit rate of the bus."""
    identifier: Annotated[Literal["standard", "extended"], _FRAME_FORMATS] = "standard"
    """`standard`: identifiers of 11 bits; `extended`: 29 bits."""
    identifiers: dict[Name, CanIdentifier] = Field(default_factory=dict)
    """Identifiers of messages, e.g. `{odometry_topic: 0x120, lift_request: 0x80}`; all others have one that loses against these."""
    interrupt: Interrupt | None = None
    """The interrupt for each received frame; if omitted, its cost is part of other execution times."""


class Transport(Section):
    """The transport between the controller and the agent."""

    can: Can | None = None
    """The CAN bus, if messages are sent over CAN."""
    overhead: SizeOrNothing = 12 * 8
    """Overhead of XRCE-DDS per message: message header, submessage header and object ids; default: 12 B."""
    acknowledgement: Duration | None = None
    """Maximum time until a reliable message is acknowledged."""


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
    RMW_UXRCE_MTU: Size | None = None
    """Maximum size of a message of the transport."""
    RMW_UXRCE_STREAM_HISTORY: Count | None = None
    """MTU-sized buffers of a reliable stream."""


_POLICIES = described(
    FixedPriorityPreemptive="The ready task with the highest priority executes.",
    OSEK="As `FixedPriorityPreemptive`, with the task types and the priority ceiling protocol of OSEK.",
)


class Middleware(Section):
    """The generic micro-ROS model of a platform."""

    policy: Annotated[Literal["FixedPriorityPreemptive", "OSEK"], _POLICIES] = "FixedPriorityPreemptive"
    """Scheduling policy of the operating system."""
    task_periods: list[Duration] = Field(default_factory=list)
    """Available task periods; if omitted, any period is available."""
    executor: Executor = Field(default_factory=Executor)
    """The executor."""
    publish: MessageCost = Field(default_factory=MessageCost)
    """Execution time of publishing a message, added to that of the callback."""
    transport: Transport = Field(default_factory=Transport)
    """The transport to the agent."""
    initialisation: Initialisation = Field(default_factory=Initialisation)
    """Creation of the entities."""
    limits: PoolSizes = Field(default_factory=PoolSizes)
    """Static pools."""
