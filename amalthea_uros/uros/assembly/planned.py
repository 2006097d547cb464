"""What an assembly plans: tasks and interrupt service routines without allocated priorities, their activities, and stimuli."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.activities import (
    AccessKind,
    Activity,
    Execute,
    LabelAccess,
    SemaphoreAccess,
    SemaphoreOperation,
    Send,
    Trigger,
    Waiting,
)
from amalthea_uros.perf.software import Isr, IsrCategory, Preemption, Task
from amalthea_uros.perf.stimuli import Periodic, Stimulus
from amalthea_uros.spec.os import OsSection, OverheadSection
from amalthea_uros.units import Time, time_text


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedTask:
    """A task.

    Attributes
    ----------
    stimuli : names
    period : minimum time between two activations; None if unknown
    priority : as set in the description; None to assign one
    wins_ties : whether it gets a higher priority than other tasks of the same period
    thread : tasks with the same one are parts of one thread, with one priority; "" for a thread of its own
    overhead : what the description states for it; `uros.overheads` makes activities of it
    """

    name: str
    core: str
    stimuli: tuple[str, ...]
    activities: tuple[Activity, ...]
    period: Time | None
    priority: int | None = None
    deadline: Time | None = None
    preemption: Preemption = Preemption.PREEMPTIVE
    activation_limit: int = 1
    wins_ties: bool = False
    thread: str = ""
    overhead: OverheadSection | None = None
    origin: Location | None = None

    @property
    def task(self) -> Task:
        """The task of the system."""
        return Task(
            name=self.name,
            stimuli=self.stimuli,
            activities=self.activities,
            preemption=self.preemption,
            activation_limit=self.activation_limit,
            origin=self.origin,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedIsr:
    """An interrupt service routine."""

    name: str
    core: str
    stimuli: tuple[str, ...]
    activities: tuple[Activity, ...]
    priority: int
    category: IsrCategory = IsrCategory.CATEGORY_2
    overhead: OverheadSection | None = None
    origin: Location | None = None

    @property
    def isr(self) -> Isr:
        """The interrupt service routine of the system."""
        return Isr(name=self.name, stimuli=self.stimuli, activities=self.activities, category=self.category, origin=self.origin)


@dataclass(frozen=True, slots=True)
class PriorityScale:
    """Converts the numbers of priorities in a description to those of a system, where a higher number is more urgent.

    Attributes
    ----------
    zero : the number that becomes 0, where lower numbers are more urgent; None if higher ones are
    """

    zero: int | None = None

    def rank(self, number: int) -> int:
        """A priority of the description as one of the system."""
        return number if self.zero is None else self.zero - number

    def number(self, rank: int) -> int:
        """A priority of the system as one of the description; the conversion is its own inverse."""
        return self.rank(rank)


#: What priorities mean if nothing else is stated.
HIGHER_IS_MORE_URGENT = PriorityScale()


def priority_scale(os: OsSection, tasks: Iterable[PlannedTask]) -> PriorityScale:
    """The scale of priorities: from the highest number of the operating system, or one that leaves room for all tasks."""
    if os.priorities != "lower-is-more-urgent":
        return HIGHER_IS_MORE_URGENT
    if os.priority_range is not None:
        return PriorityScale(os.priority_range.highest)
    planned = list(tasks)
    return PriorityScale(max((task.priority for task in planned if task.priority is not None), default=0) + len(planned))


class StimulusRegistry:
    """The stimuli of a system, created as processes need them."""

    def __init__(self) -> None:
        self._by_name: dict[str, Stimulus] = {}

    @property
    def stimuli(self) -> tuple[Stimulus, ...]:
        """All stimuli in the order of their creation."""
        return tuple(self._by_name.values())

    def add(self, stimulus: Stimulus) -> str:
        """Add the stimulus of a single process, and return its name."""
        self._by_name[stimulus.name] = stimulus
        return stimulus.name

    def periodic(self, period: Time, offset: Time, origin: Location | None) -> str:
        """The name of the stimulus with a period and an offset; created on first use."""
        name = (f"every_{time_text(period)}" + (f"_from_{time_text(offset)}" if offset else "")).replace(" ", "_")
        return self.add(self._by_name.get(name) or Periodic(name=name, period=period, offset=offset, origin=origin))


def trigger_name(task: str) -> str:
    """The name of the stimulus that triggers a task."""
    return f"trigger_of_{task}"


def activity_sequence(
    execute: Iterable[Execute],
    *,
    reads: Iterable[str] = (),
    writes: Iterable[str] = (),
    sends: Iterable[str] = (),
    triggers: Iterable[str] = (),
    locks: Iterable[str] = (),
) -> tuple[Activity, ...]:
    """The activities of a runnable; locks are released in reverse order."""
    held = list(locks)
    return (
        *(_access(lock, SemaphoreOperation.REQUEST) for lock in held),
        *(LabelAccess(label=label, kind=AccessKind.READ) for label in reads),
        *execute,
        *(LabelAccess(label=label, kind=AccessKind.WRITE) for label in writes),
        *(Send(channel=channel) for channel in sends),
        *(_access(lock, SemaphoreOperation.RELEASE) for lock in reversed(held)),
        *(Trigger(stimulus=trigger_name(task)) for task in triggers),
    )


def _access(lock: str, operation: SemaphoreOperation) -> SemaphoreAccess:
    return SemaphoreAccess(semaphore=lock, operation=operation, waiting=Waiting.PASSIVE)
