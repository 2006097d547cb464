"""Blocking by tasks of lower priority: non-preemptive regions and critical sections.

Under the immediate ceiling protocol at most one region or one critical section blocks (L. Sha, R. Rajkumar and J. Lehoczky, "Priority
inheritance protocols: an approach to real-time synchronization", IEEE Transactions on Computers 39(9), 1990; for deadlines T. P. Baker,
"Stack-based scheduling of realtime processes", Real-Time Systems 3, 1991). A task of a group runs at the ceiling of its group, which is
equivalent to a critical section around its whole job (internal resources, OSEK OS 2.2.3, section 8.6).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from amalthea_uros.perf.os import Semaphore
from amalthea_uros.perf.software import Activity, Preemption
from amalthea_uros.timing.critical_sections import critical_sections
from amalthea_uros.timing.demand import DemandModel
from amalthea_uros.timing.notes import Notes
from amalthea_uros.timing.preemption import preemption, regions
from amalthea_uros.timing.scheduling import EqualPriority, Rank, ScheduledProcess
from amalthea_uros.units import Time


@dataclass(slots=True)
class Blocking:
    """The processes of a core, or of a server, that may block each other."""

    processes: Sequence[ScheduledProcess]
    demand_model: DemandModel
    ceilings: dict[str, Rank] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for item in self.processes:
            for name, _ in self._sections(item):
                self.ceilings[name] = max(self.ceilings.get(name, item.urgency), item.urgency)

    def times(self) -> Mapping[str, Time]:
        """The maximum time for which tasks of lower priority block each process."""
        longest = {item.name: max(self._regions(item), default=0) for item in self.processes}
        sections = {item.name: list(self._sections(item)) for item in self.processes}
        found = {}
        for item in self.processes:
            blocking = [0]
            for other in self.processes:
                if not _is_below(other, item):
                    continue
                if _waits_for(item, other):
                    blocking.append(longest[other.name])
                blocking += [length for name, length in sections[other.name] if self.ceilings[name] >= item.urgency]
            found[item.name] = max(blocking)
        return found

    def preempts(self, other: ScheduledProcess, item: ScheduledProcess) -> bool:
        """Whether one process can preempt another one immediately at any point."""
        if other.is_isr != item.is_isr:
            return other.is_isr
        if other.rank <= item.rank or preemption(item) is Preemption.NON_PREEMPTIVE:
            return False
        if item.group is not None and other.urgency <= self.ceilings[item.group]:
            return False
        return not (preemption(item) is preemption(other) is Preemption.COOPERATIVE)

    def last_region(self, item: ScheduledProcess) -> Time:
        """The shortest possible last region of a job: regions after the last one that is always executed may be skipped."""
        if preemption(item) is Preemption.NON_PREEMPTIVE:
            return self._demand(item.process.activities, item)
        found: list[Time] = []
        for region in reversed(regions(item)):
            demand = self.demand_model.of_activities(item.process, region, item.core)
            if demand.worst:
                found.append(demand.worst)
            if any(frame.is_always and frame.worst for frame in demand.frames):
                break
        return min(found, default=0)

    def _regions(self, item: ScheduledProcess) -> list[Time]:
        """The demands of the regions in which cooperative tasks cannot preempt a task: the whole task, or each activity."""
        match preemption(item):
            case Preemption.NON_PREEMPTIVE:
                return [self._demand(item.process.activities, item)]
            case Preemption.COOPERATIVE:
                return [self._demand((activity,), item) for activity in item.process.activities]
        return []

    def _sections(self, item: ScheduledProcess) -> Iterator[tuple[str, Time]]:
        """The critical sections of a process: semaphore and maximum execution time while it is held."""
        if item.group is not None:
            yield item.group, max(self._demand(region, item) for region in regions(item))
        for semaphore, activities in critical_sections(item.process, self.demand_model.system):
            yield semaphore, self._demand(activities, item)

    def _demand(self, activities: Sequence[Activity], item: ScheduledProcess) -> Time:
        if activities is item.process.activities:
            return self.demand_model.of_process(item.process, item.core).worst
        return self.demand_model.of_activities(item.process, activities, item.core).worst

    def note_protocols(self, notes: Notes) -> None:
        """Report semaphores without a priority ceiling."""
        semaphores: Mapping[str, Semaphore] = {s.name: s for s in self.demand_model.system.os.semaphores}
        for name in self.ceilings:
            semaphore = semaphores.get(name)
            if semaphore is not None and not semaphore.ceiling:
                message = f"the semaphore {name!r} has no priority ceiling; it is analysed as if it had one"
                notes.warning("ANA003", message, semaphore)


def _is_below(other: ScheduledProcess, item: ScheduledProcess) -> bool:
    """Whether a process has lower priority than another one; under round robin, also those of equal priority can block."""
    takes_turns = other is not item and other.rank == item.rank and item.equal_priority is EqualPriority.ROUND_ROBIN
    return takes_turns or other.urgency < item.urgency


def _waits_for(item: ScheduledProcess, other: ScheduledProcess) -> bool:
    """Whether a task waits for a region of a lower one; preemptive tasks preempt cooperative ones immediately."""
    if item.is_isr:
        return False
    return preemption(other) is Preemption.NON_PREEMPTIVE or preemption(item) is not Preemption.PREEMPTIVE
