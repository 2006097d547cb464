"""The ordinary load of the controller: tasks, interrupt service routines and labels."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from amalthea_uros.spec.execution_time import ExecutionTime
from amalthea_uros.spec.section import Section, Shorthand
from amalthea_uros.spec.values import Count, CountOrNone, Duration, Name, Offset, Priority, SizeOrNothing


class Sporadic(Shorthand):
    """Activation at varying distances: the least distance, or a mapping with both."""

    shorthand = ("min",)

    min: Duration
    """Least time between two activations."""
    max: Duration | None = None
    """Most time between two activations; default: the least."""


class Burst(Section):
    """Several activations at the start of each period."""

    period: Duration
    """Period of the bursts."""
    count: Count
    """Activations in a burst."""
    distance: Duration
    """Time between two activations of a burst."""
    offset: Offset = 0
    """Time of the first burst."""


class Times(Section):
    """A list of activations that repeats."""

    period: Duration
    """After which time the list starts again."""
    at: list[Offset] = Field(min_length=1)
    """Activations, relative to the start of the period."""
    offset: Offset = 0
    """Time of the first period."""


class Steps(Section):
    """What a function or a process does."""

    execution_time: ExecutionTime | None = None
    """How long it executes."""
    reads: list[Name] = Field(default_factory=list)
    """Labels that it reads when it starts."""
    writes: list[Name] = Field(default_factory=list)
    """Labels that it writes when it ends."""
    triggers: list[Name] = Field(default_factory=list)
    """Tasks that it activates when it ends."""
    locks: list[Name] = Field(default_factory=list)
    """Resources that it holds while it executes; the priority ceiling protocol applies."""


class Runnable(Steps):
    """A function of a task or interrupt service routine."""

    name: Name
    """Name of the function; the same name in several processes is the same function."""
    every: Count = 1
    """Runs every n-th time only."""
    first: CountOrNone = 0
    """Number of the first time, counted from 1; default: the n of `every`."""


class Process(Steps):
    """What tasks and interrupt service routines have; exactly one kind of activation is stated."""

    name: Name
    """Name of the process."""
    period: Duration | None = None
    """Periodic activation."""
    offset: Offset = 0
    """Time of the first activation, for `period`."""
    jitter: Duration | None = None
    """Most delay of an activation against the ideal grid, for `period`."""
    sporadic: Sporadic | None = None
    """Sporadic activation."""
    burst: Burst | None = None
    """Activation in bursts."""
    times: Times | None = None
    """Activation by a list of times that repeats."""
    once: Offset | None = None
    """A single activation."""
    core: Name | None = None
    """Default: the first core."""
    deadline: Duration | None = None
    """Relative to the activation."""
    runnables: list[Runnable] = Field(default_factory=list)
    """Its functions, in order; a process with one function needs none."""


class Task(Process):
    """A task of the controller."""

    priority: Priority | None = None
    """Higher numbers are served first; default: rate monotonic."""
    preemption: Literal["preemptive", "cooperative", "non-preemptive"] = "preemptive"
    """When other tasks may preempt it."""
    activation_limit: Count = 1
    """Most jobs at a time; further activations are lost."""


class Isr(Process):
    """An interrupt service routine of the controller."""

    priority: Priority = 1
    """Priority among interrupt service routines."""
    category: Literal[1, 2] = 2
    """Category of OSEK."""


class Label(Shorthand):
    """A variable: its size, or a mapping with more."""

    shorthand = ("size",)

    size: SizeOrNothing = 4 * 8
    """Default: 4 B."""
    memory: Name | None = None
    """The memory that holds it; default: the `label_memory` of the hardware."""
