"""How long tasks of lower priority can hold up a task: regions that cannot be interrupted, and critical sections.

One region or one critical section at most is in the way under the immediate ceiling protocol (L. Sha, R. Rajkumar and J. Lehoczky,
"Priority inheritance protocols: an approach to real-time synchronization", IEEE Transactions on Computers 39(9), 1990; for deadlines
T. P. Baker, "Stack-based scheduling of realtime processes", Real-Time Systems 3, 1991). A task of a group runs at the ceiling of its
group, which is the same as a critical section around all that it does (internal resources, OSEK OS 2.2.3, section 8.6).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from amalthea_uros.analyze.response_times.task import Sharing
from amalthea_uros.perf.os import Semaphore
from amalthea_uros.perf.software import (
    Activity,
    Call,
    Preemption,
    SchedulePoint,
    SemaphoreAccess,
    SemaphoreOperation,
    Task,
)
from amalthea_uros.timing.demand import Demands
from amalthea_uros.timing.notes import Notes
from amalthea_uros.timing.scheduling import Placed, Rank
from amalthea_uros.units import Time


def preemption(placed: Placed) -> Preemption:
    """Who can interrupt a process; interrupts always can, and nobody but them an interrupt service routine."""
    return placed.process.preemption if isinstance(placed.process, Task) else Preemption.PREEMPTIVE


def is_interruptible(placed: Placed) -> bool:
    """Whether all of higher priority can interrupt a process at once."""
    return preemption(placed) is Preemption.PREEMPTIVE and placed.group is None


@dataclass(slots=True)
class Blocking:
    """The processes of a core, or of a server, that may hold up each other."""

    placed: Sequence[Placed]
    demands: Demands
    ceilings: dict[str, Rank] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for item in self.placed:
            for name, _ in self._sections(item):
                self.ceilings[name] = max(self.ceilings.get(name, item.urgency), item.urgency)

    def times(self) -> Mapping[str, Time]:
        """The longest that each process can wait for one of lower priority."""
        stretches = {item.name: max(self._regions(item), default=0) for item in self.placed}
        sections = {item.name: list(self._sections(item)) for item in self.placed}
        found = {}
        for item in self.placed:
            waits = [0]
            for other in self.placed:
                if not _is_below(other, item):
                    continue
                if _waits_for(item, other):
                    waits.append(stretches[other.name])
                waits += [length for name, length in sections[other.name] if self.ceilings[name] >= item.urgency]
            found[item.name] = max(waits)
        return found

    def interrupts(self, other: Placed, item: Placed) -> bool:
        """Whether one process can interrupt another one at once, anywhere."""
        if other.is_isr != item.is_isr:
            return other.is_isr
        if other.rank <= item.rank or preemption(item) is Preemption.NON_PREEMPTIVE:
            return False
        if item.group is not None and other.urgency <= self.ceilings[item.group]:
            return False
        return not (preemption(item) is preemption(other) is Preemption.COOPERATIVE)

    def last_region(self, item: Placed) -> Time:
        """The shortest region with which a job can end: behind the last one that is executed each time others may not be."""
        if preemption(item) is Preemption.NON_PREEMPTIVE:
            return self._cost(item.process.activities, item)
        found: list[Time] = []
        for piece in reversed(_pieces(item)):
            cost = self.demands.piece(item.process, piece, item.core)
            if cost.worst:
                found.append(cost.worst)
            if any(part.prescaler == 1 and part.worst for part in cost.parts):
                break
        return min(found, default=0)

    def _regions(self, item: Placed) -> list[Time]:
        """The stretches of a task that cooperative tasks cannot interrupt: all of it, or its runnables one by one."""
        match preemption(item):
            case Preemption.NON_PREEMPTIVE:
                return [self._cost(item.process.activities, item)]
            case Preemption.COOPERATIVE:
                return [self._cost((activity,), item) for activity in item.process.activities]
        return []

    def _sections(self, item: Placed) -> Iterator[tuple[str, Time]]:
        """The critical sections of a process: semaphore, and how long it is held at most."""
        if item.group is not None:
            yield item.group, max(self._cost(piece, item) for piece in _pieces(item))
        held: dict[str, list[Activity]] = {}
        for activity in _flat(item.process.activities, self.demands):
            if isinstance(activity, SemaphoreAccess):
                if activity.operation is not SemaphoreOperation.RELEASE:
                    held.setdefault(activity.semaphore, [])
                elif activity.semaphore in held:
                    yield activity.semaphore, self._cost(held.pop(activity.semaphore), item)
            else:
                for inside in held.values():
                    inside.append(activity)
        for name in held:
            # Never released: held until the end of the job.
            yield name, self._cost(item.process.activities, item)

    def _cost(self, activities: Sequence[Activity], item: Placed) -> Time:
        if activities is item.process.activities:
            return self.demands.cost(item.process, item.core).worst
        return self.demands.piece(item.process, activities, item.core).worst

    def note_protocols(self, notes: Notes) -> None:
        """Note the semaphores that are taken to have a ceiling, and have none."""
        semaphores: Mapping[str, Semaphore] = {s.name: s for s in self.demands.system.os.semaphores}
        for name in self.ceilings:
            semaphore = semaphores.get(name)
            if semaphore is not None and not semaphore.ceiling:
                message = f"the semaphore {name!r} has no priority ceiling; it is analysed as if it had one"
                notes.warning("ANA003", message, semaphore)


def _is_below(other: Placed, item: Placed) -> bool:
    """Whether one process comes behind another one; in round robin each does."""
    in_turn = other is not item and other.rank == item.rank and item.sharing is Sharing.SLICES
    return in_turn or other.urgency < item.urgency


def _waits_for(item: Placed, other: Placed) -> bool:
    """Whether a task waits for the region of a lower one; preemptive tasks interrupt cooperative ones at once."""
    if item.is_isr:
        return False
    return preemption(other) is Preemption.NON_PREEMPTIVE or preemption(item) is not Preemption.PREEMPTIVE


def _pieces(item: Placed) -> list[tuple[Activity, ...]]:
    """What a task executes between the points at which it lets others go first: its activities one by one, or for groups more."""
    activities = item.process.activities
    if preemption(item) is Preemption.COOPERATIVE and item.group is None:
        return [(activity,) for activity in activities]
    pieces: list[tuple[Activity, ...]] = [()]
    for activity in activities:
        if isinstance(activity, SchedulePoint):
            pieces.append(())
        else:
            pieces[-1] += (activity,)
    return pieces


def semaphores_of(placed: Placed, demands: Demands) -> set[str]:
    """The semaphores that a process uses."""
    found = _flat(placed.process.activities, demands)
    return {activity.semaphore for activity in found if isinstance(activity, SemaphoreAccess)}


def _flat(activities: Sequence[Activity], demands: Demands, above: tuple[str, ...] = ()) -> Iterator[Activity]:
    """The activities of a process with those of the runnables that it calls, as far as semaphores are involved."""
    for activity in activities:
        runnable = demands.system.runnables.get(activity.runnable) if isinstance(activity, Call) else None
        if runnable is not None and runnable.name not in above and _locks(runnable.activities):
            yield from _flat(runnable.activities, demands, (*above, runnable.name))
        else:
            yield activity


def _locks(activities: Sequence[Activity]) -> bool:
    return any(isinstance(activity, SemaphoreAccess) for activity in activities)
