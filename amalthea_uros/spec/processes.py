"""Tasks, interrupt service routines and labels outside the micro-ROS application."""

from __future__ import annotations

from typing import Annotated, Literal

from amalthea_uros.spec.execution_time import ExecutionTimeSection
from amalthea_uros.spec.fields import entry
from amalthea_uros.spec.os import OverheadSection
from amalthea_uros.spec.section import DescriptionSection, Shorthand
from amalthea_uros.spec.values import (
    WHOLE_NUMBER,
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


class SporadicSection(Shorthand):
    """Sporadic activation: the minimum interarrival time, or a mapping with minimum and maximum."""

    shorthand = ("min",)
    plain_value = "Minimum time between two activations; the maximum time is unknown."

    min: Duration
    """Minimum time between two activations."""
    max: Duration | None = None
    """Maximum time between two activations; default: unknown."""


class BurstSection(DescriptionSection):
    """Several activations at the start of each period."""

    period: Duration
    """Period of the bursts."""
    count: Count
    """Number of activations in a burst."""
    distance: Duration
    """Time between two activations of a burst."""
    offset: Offset = 0
    """Start of the first burst."""


class Times(DescriptionSection):
    """A list of activations that repeats."""

    period: Duration
    """Time after which the list repeats."""
    at: list[Offset] = entry(min_length=1)
    """Times of the activations, relative to the start of the period."""
    offset: Offset = 0
    """Start of the first period."""


class Steps(DescriptionSection):
    """Execution time, accesses and triggers of a function or a process."""

    execution_time: ExecutionTimeSection | None = None
    """Execution time."""
    reads: list[Name] = entry(default_factory=list)
    """Labels that it reads at its start."""
    writes: list[Name] = entry(default_factory=list)
    """Labels that it writes at its end."""
    triggers: list[Name] = entry(default_factory=list)
    """Tasks that it activates at its end."""
    locks: list[Name] = entry(default_factory=list)
    """Resources that it holds during its execution (priority ceiling protocol)."""


class RunnableSection(Steps):
    """A function of a task or interrupt service routine."""

    name: Name
    """Name of the function; the same name in several processes means the same function."""
    every: Count = 1
    """It runs only in every n-th job of the process."""
    first: CountOrNone = 0
    """Number of the first job in which it runs, counted from 1; default: the n of `every`."""


class ProcessSection(Steps):
    """Keys that tasks and interrupt service routines have; exactly one kind of activation is given."""

    name: Name
    """Name of the process."""
    period: Duration | None = None
    """Periodic activation."""
    offset: Offset = 0
    """Time of the first activation, for `period`."""
    jitter: Duration | None = None
    """Maximum deviation from the nominal activation time, for `period`."""
    sporadic: SporadicSection | None = None
    """Sporadic activation."""
    burst: BurstSection | None = None
    """Activation in bursts."""
    times: Times | None = None
    """Activation by a list of times that repeats."""
    once: Offset | None = None
    """A single activation."""
    core: Name | None = None
    """Core that it runs on; default: the first core."""
    deadline: Duration | None = None
    """Deadline relative to the activation."""
    overhead: OverheadSection | None = None
    """Overhead of the operating system per job; default: that of `os`."""
    runnables: list[RunnableSection] = entry(default_factory=list)
    """Its functions, in order; unnecessary for a process with one function."""
    stack: Size | None = None
    """Its stack; for tasks that share one stack: the most that it uses itself."""


_PREEMPTIONS = described(
    preemptive="At any time.",
    cooperative="Cooperative tasks only between two of its functions, others at any time.",
    non_preemptive="Never.",
)


class TaskSection(ProcessSection):
    """A task of the controller."""

    priority: Priority | None = None
    """Priority; a higher number is a higher priority; default: rate monotonic."""
    preemption: Annotated[Literal["preemptive", "cooperative", "non-preemptive"], _PREEMPTIONS] = "preemptive"
    """When other tasks may preempt it."""
    activation_limit: Count = 1
    """Maximum number of pending jobs; further activations are lost."""


class IsrSection(ProcessSection):
    """An interrupt service routine of the controller."""

    priority: Priority = 1
    """Priority among interrupt service routines."""
    category: Annotated[Literal[1, 2], WHOLE_NUMBER] = 2
    """OSEK category."""


class LabelSection(Shorthand):
    """A variable: its size, or a mapping with more."""

    shorthand = ("size",)
    plain_value = "Size of the variable."

    size: SizeOrNothing = 4 * 8
    """Size; default: 4 B."""
    memory: Name | None = None
    """Memory in which it is stored; default: the `label_memory` of the hardware."""
