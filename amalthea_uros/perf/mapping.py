"""Which scheduler dispatches which task, and which memory holds which label."""

from __future__ import annotations

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.named import Brief, Located
from amalthea_uros.perf.os import Parameter
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True, kw_only=True)
class TaskAllocation(Located):
    """A task on a scheduler.

    Attributes
    ----------
    priority : higher numbers are served first
    deadline : relative to the activation
    cores : those of the scheduler's that the task may use; empty: all of them
    """

    task: str
    scheduler: str
    priority: int | None = None
    deadline: Time | None = None
    cores: tuple[str, ...] = ()
    parameters: tuple[Parameter, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class IsrAllocation(Located):
    """An interrupt service routine on an interrupt controller."""

    isr: str
    controller: str
    priority: int | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Placement(Located):
    """A label, channel or other element in a memory.

    Attributes
    ----------
    address : in bytes
    """

    element: str
    memory: str
    address: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Mapping(Brief):
    """The mapping of software to hardware."""

    tasks: tuple[TaskAllocation, ...] = ()
    isrs: tuple[IsrAllocation, ...] = ()
    placements: tuple[Placement, ...] = ()
