"""Software: tasks, interrupt service routines, runnables, and the data that they share."""

from __future__ import annotations

from collections.abc import Iterator
from enum import StrEnum
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.activities import Activity, Protection
from amalthea_uros.perf.conditions import Condition
from amalthea_uros.perf.named import Brief, Named
from amalthea_uros.units import DataSize

#: The activation limit of what waits in any number: iterations that are due, and messages until a wire or a task is free.
UNLIMITED = 1_000_000


class Preemption(StrEnum):
    """When other tasks may preempt a task: always, at schedule points, or never."""

    PREEMPTIVE = "preemptive"
    COOPERATIVE = "cooperative"
    NON_PREEMPTIVE = "non-preemptive"


@dataclass(frozen=True, slots=True, kw_only=True)
class Task(Named):
    """A process that a scheduler dispatches.

    Attributes
    ----------
    activation_limit : most jobs at a time; further activations are lost
    """

    stimuli: tuple[str, ...] = ()
    activities: tuple[Activity, ...] = ()
    preemption: Preemption = Preemption.PREEMPTIVE
    activation_limit: int = 1


class IsrCategory(StrEnum):
    """The categories of OSEK."""

    CATEGORY_1 = "category 1"
    CATEGORY_2 = "category 2"


@dataclass(frozen=True, slots=True, kw_only=True)
class Isr(Named):
    """An interrupt service routine."""

    stimuli: tuple[str, ...] = ()
    activities: tuple[Activity, ...] = ()
    category: IsrCategory | None = None


Process: TypeAlias = Task | Isr


@dataclass(frozen=True, slots=True, kw_only=True)
class Runnable(Named):
    """A function.

    Attributes
    ----------
    callback : whether the executor of a middleware calls it
    is_overhead : whether it is work of the operating system for the job that calls it
    condition : without it being true, calls have no effect
    """

    activities: tuple[Activity, ...] = ()
    callback: bool = False
    service: bool = False
    is_overhead: bool = False
    condition: Condition | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Label(Named):
    """A variable."""

    size: DataSize | None = None
    constant: bool = False
    volatile: bool = False
    protection: Protection | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Channel(Named):
    """A queue; sizes in bits, capacity in elements.

    Attributes
    ----------
    external : elements leave the system on their way, as the messages of a topic do that pass an agent: it is unknown when they
        arrive
    """

    element_size: DataSize | None = None
    default_elements: int = 0
    capacity: int = 0
    external: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class OsEvent(Named):
    """An event of the operating system."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Mode(Named):
    """What a mode label can hold: literals, or numbers if there are none."""

    literals: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class ModeLabel(Named):
    """A variable on which behaviour depends."""

    mode: str | None = None
    initial: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Software(Brief):
    """All software of a system."""

    tasks: tuple[Task, ...] = ()
    isrs: tuple[Isr, ...] = ()
    runnables: tuple[Runnable, ...] = ()
    labels: tuple[Label, ...] = ()
    channels: tuple[Channel, ...] = ()
    os_events: tuple[OsEvent, ...] = ()
    modes: tuple[Mode, ...] = ()
    mode_labels: tuple[ModeLabel, ...] = ()

    @property
    def bodies(self) -> Iterator[tuple[Activity, ...]]:
        """The activities of each process and of each runnable."""
        yield from (task.activities for task in self.tasks)
        yield from (isr.activities for isr in self.isrs)
        yield from (runnable.activities for runnable in self.runnables)
