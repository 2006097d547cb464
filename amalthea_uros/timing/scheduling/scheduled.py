"""How processes and servers are scheduled: the core, the rank among others, and whether they can be preempted."""

from __future__ import annotations

from enum import StrEnum

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.os import Scheduler
from amalthea_uros.perf.software import Preemption, Process, Task
from amalthea_uros.units import Time

#: Order of service, compared from left to right: interrupts before tasks, then the priorities from the outermost scheduler inwards.
Rank = tuple[int, ...]


class EqualPriority(StrEnum):
    """Order of service among equal priorities."""

    FIFO = "first come, first served"
    EDF = "earliest deadline first"
    ROUND_ROBIN = "round robin"
    TIME_SLICES = "time slices"
    UNKNOWN = "an order that is not stated"


class OrderGap(StrEnum):
    """Why the order of service is not stated."""

    NO_PRIORITY = "it has no priority"
    OTHER_WITHOUT_PRIORITY = "a task of its scheduler has no priority"
    NO_DEADLINE = "no deadline is stated for its scheduler"
    OTHER_WITHOUT_DEADLINE = "another task of its scheduler has no deadline stated for it"

    @property
    def is_of_priority(self) -> bool:
        """Whether priorities would state it."""
        return self in (OrderGap.NO_PRIORITY, OrderGap.OTHER_WITHOUT_PRIORITY)


@dataclass(frozen=True, slots=True)
class StatedPlace:
    """The stated place of a task in an order of which a part is unknown; higher is served first.

    Attributes
    ----------
    ceiling : at which it executes, the highest of its group
    """

    priority: int
    ceiling: int


@dataclass(frozen=True, slots=True, kw_only=True)
class SchedulingContext:
    """How something is scheduled.

    Attributes
    ----------
    server : whose budget it uses; None: it runs on the core itself
    rank : higher is served first
    equal_priority, slice : how tasks of the same rank share the core; no slice: 0
    group : its members do not preempt each other
    order_gap : why the order among those of the same rank is unknown; None if it is known
    place : among those with an unknown order, where it is stated for some; None: it can have any place
    """

    core: str = ""
    server: str | None = None
    rank: Rank = (0,)
    equal_priority: EqualPriority = EqualPriority.FIFO
    deadline: Time | None = None
    slice: Time = 0
    group: str | None = None
    order_gap: OrderGap | None = None
    place: StatedPlace | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ScheduledProcess(SchedulingContext):
    """A process on a core."""

    process: Process
    is_isr: bool
    priority: int | None

    @property
    def name(self) -> str:
        """The name of the process."""
        return self.process.name


@dataclass(frozen=True, slots=True, kw_only=True)
class Server(SchedulingContext):
    """A scheduler with a budget in each period, in which it serves its tasks."""

    scheduler: Scheduler
    budget: Time
    period: Time

    @property
    def name(self) -> str:
        """The name of the scheduler."""
        return self.scheduler.name


def is_below(place: StatedPlace | None, other: StatedPlace | None) -> bool:
    """Whether what has one place never executes while what has the other one is pending."""
    return place is not None and other is not None and place.ceiling < other.priority


def preemption(item: ScheduledProcess) -> Preemption:
    """The preemption mode of a process; an ISR is preempted only by interrupts of higher priority."""
    return item.process.preemption if isinstance(item.process, Task) else Preemption.PREEMPTIVE


def is_preemptive(item: ScheduledProcess) -> bool:
    """Whether every process of higher rank can preempt a process immediately."""
    return preemption(item) is Preemption.PREEMPTIVE and item.group is None
