"""Blocking: how long processes of lower priority keep a process off the core, and which of them interfere like higher ones.

Under the immediate ceiling protocol at most one stretch of one process blocks (L. Sha, R. Rajkumar and J. Lehoczky, "Priority
inheritance protocols: an approach to real-time synchronization", IEEE Transactions on Computers 39(9), 1990; for deadlines T. P. Baker,
"Stack-based scheduling of realtime processes", Real-Time Systems 3, 1991). A task of a group runs at the ceiling of its group, which is
equivalent to a critical section around its whole job (internal resources, OSEK OS 2.2.3, section 8.6).

A busy window of a process is an interval in which processes of at least its level are pending. Processes of lower priority can
execute in it for two more reasons, and then the level is lowered until they belong to it:

- A semaphore without a ceiling does not raise the priority of its holder: everything above the holder delays it, and those that wait.
  While any process of the lowered level is pending, the core executes one of the level, in whatever order.
- While a cooperative task is in a stretch that keeps off another cooperative one, preemptive tasks between the two preempt it at once.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from amalthea_uros.analyze.solution import Solution
from amalthea_uros.perf.software import Activity, Preemption
from amalthea_uros.timing.critical_sections import Protection
from amalthea_uros.timing.demand import DemandModel
from amalthea_uros.timing.preemption import preemption
from amalthea_uros.timing.scheduling import EqualPriority, Rank, ScheduledProcess
from amalthea_uros.timing.stretches import KeptOff, Stretches, StretchWalk
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True)
class Level:
    """The processes that interfere with a process: those of at least a rank.

    Attributes
    ----------
    is_flat : whether those of the lowest ranks are served in any order, so that all of them interfere
    """

    rank: Rank
    is_flat: bool = False


@dataclass(slots=True)
class Blocking:
    """The processes of a core, or of a server, that may block each other.

    Attributes
    ----------
    protection : what each process uses to keep others off
    unknown : processes whose demand or locks are unknown
    open_semaphores : those whose users can wait for somebody who does not run at the ceiling
    """

    processes: Sequence[ScheduledProcess]
    demand_model: DemandModel
    protection: Mapping[str, Protection]
    unknown: frozenset[str] = frozenset()
    open_semaphores: frozenset[str] = frozenset()
    _ceilings: dict[str, Rank] = field(default_factory=dict)
    _stretches: dict[tuple[str, KeptOff], Stretches] = field(default_factory=dict)
    _levels: dict[str, Level] = field(default_factory=dict)

    @classmethod
    def of(cls, processes: Sequence[ScheduledProcess], solution: Solution) -> Blocking:
        """The blocking among processes of a core, or of a server."""
        context = solution.context
        unknown = frozenset(item.name for item in processes if not solution.is_analysable(item.name))
        return cls(processes, context.demand_model, context.protection, unknown, context.open_semaphores)

    def __post_init__(self) -> None:
        for item in self.processes:
            for name in self._exclusions(item):
                self._ceilings[name] = max(self._ceilings.get(name, item.rank), item.rank)

    def _exclusions(self, item: ScheduledProcess) -> Iterator[str]:
        """The semaphores that a process uses, and its group."""
        yield from self.protection[item.name].semaphores
        if item.group is not None:
            yield item.group

    @property
    def is_possible(self) -> bool:
        """Whether any process can keep another one off that it does not precede."""
        return any(map(self.keeps_off_others, self.processes))

    def keeps_off_others(self, item: ScheduledProcess) -> bool:
        """Whether a process is not preempted in some part of its jobs."""
        uses = self.protection[item.name]
        is_preemptive = preemption(item) is Preemption.PREEMPTIVE and item.group is None
        return not is_preemptive or bool(uses.semaphores) or uses.has_non_interruptible_group

    def level(self, item: ScheduledProcess) -> Level:
        """The level of the busy window of a process."""
        if item.name not in self._levels:
            self._levels[item.name] = self._level(item)
        return self._levels[item.name]

    def _level(self, item: ScheduledProcess) -> Level:
        rank = item.rank
        while True:
            above = [other for other in self.processes if other.rank >= rank]
            lowest = min([rank, *self._holders(above), *self._between(above, rank)])
            if lowest == rank:
                return Level(rank, self._is_flat(item, rank, above))
            rank = lowest

    def _holders(self, above: Sequence[ScheduledProcess]) -> Iterator[Rank]:
        """The ranks of processes for which some others wait at a semaphore without a ceiling."""
        awaited = self._awaited(above)
        return (other.rank for other in self.processes if not awaited.isdisjoint(self.protection[other.name].semaphores))

    def _awaited(self, items: Sequence[ScheduledProcess]) -> frozenset[str]:
        used = {name for item in items for name in self.protection[item.name].semaphores}
        return self.open_semaphores & used

    def _between(self, above: Sequence[ScheduledProcess], rank: Rank) -> Iterator[Rank]:
        """The ranks of tasks that preempt a cooperative one of lower rank while it keeps off one of a higher rank."""
        blocking = [
            other.rank
            for other in self.processes
            if other.rank < rank and self._throughout(other, above) and _can_be_preempted(other)
        ]
        if not blocking:
            return iter(())
        lowest = min(blocking)
        return (
            other.rank
            for other in self.processes
            if lowest < other.rank < rank and preemption(other) is not Preemption.COOPERATIVE
        )

    def _is_flat(self, item: ScheduledProcess, rank: Rank, above: Sequence[ScheduledProcess]) -> bool:
        if self._awaited(above):
            return True
        together = [other for other in self.processes if other.rank == item.rank]
        if len(together) < 2:
            return False
        match item.equal_priority:
            case EqualPriority.ROUND_ROBIN:
                # A task that cannot be preempted keeps the core for longer than its slice.
                return rank < item.rank or any(map(self.keeps_off_others, together))
            case EqualPriority.EDF:
                kinds = {preemption(other) is Preemption.COOPERATIVE for other in together}
                return rank < item.rank or len(kinds) > 1
        return rank < item.rank

    def time(self, item: ScheduledProcess) -> Time:
        """The maximum time for which a process below the level of another one keeps it off."""
        level = self.level(item)
        above = [other for other in self.processes if other.rank >= level.rank]
        return max((length for _, length in self.stretches_below(level, above)), default=0)

    def stretches_below(self, level: Level, above: Sequence[ScheduledProcess]) -> Iterator[tuple[ScheduledProcess, Time]]:
        """The longest stretch of each process below a level in which it keeps off one of the level."""
        for other in self.processes:
            if other.rank < level.rank and other.name not in self.unknown:
                yield other, self.longest_stretch(other, above)

    def obstacle(self, item: ScheduledProcess) -> str:
        """The process of lower priority that can block for an unknown time; "" if there is none."""
        level = self.level(item)
        above = [other for other in self.processes if other.rank >= level.rank]
        for other in self.processes:
            if other.name in self.unknown and other.rank < level.rank and self._may_keep_off(other, above):
                return other.name
        return ""

    def _may_keep_off(self, other: ScheduledProcess, items: Sequence[ScheduledProcess]) -> bool:
        uses = self.protection[other.name]
        shared = {name for item in items for name in self._exclusions(item)}
        return (
            uses.has_non_interruptible_group or self._throughout(other, items) or not shared.isdisjoint(self._exclusions(other))
        )

    def longest_stretch(self, other: ScheduledProcess, items: Sequence[ScheduledProcess]) -> Time:
        """The longest stretch of a process in which it keeps off one of others that precede it."""
        if preemption(other) is Preemption.NON_PREEMPTIVE and self._throughout(other, items):
            return self.demand_model.of_process(other.process, other.core).worst
        if not self.keeps_off_others(other):
            return 0
        shared = {name for item in items for name in self.protection[item.name].semaphores}
        # A semaphore keeps off all processes up to its ceiling, also those that do not use it.
        lowest = min(item.rank for item in items)
        ceilings = {name for name in self.protection[other.name].semaphores if self._ceilings[name] >= lowest}
        is_edf = any(item.equal_priority is EqualPriority.EDF for item in items) and other.rank == lowest
        semaphores = frozenset(shared & ceilings if is_edf else ceilings) - self.open_semaphores
        in_group = other.group is not None and self._ceilings[other.group] >= lowest
        kept_off = KeptOff(
            semaphores,
            throughout=self._throughout(other, items),
            yields_after_calls=not in_group and preemption(other) is Preemption.COOPERATIVE,
        )
        return self._of(other, kept_off).longest

    def _throughout(self, other: ScheduledProcess, items: Sequence[ScheduledProcess]) -> bool:
        """Whether a process keeps off one of others everywhere, apart from points at which it yields."""
        if other.group is not None and any(item.rank <= self._ceilings[other.group] for item in items):
            return True
        match preemption(other):
            case Preemption.NON_PREEMPTIVE:
                return any(not item.is_isr for item in items)
            case Preemption.COOPERATIVE:
                return any(not item.is_isr and preemption(item) is not Preemption.PREEMPTIVE for item in items)
        return False

    def preempts(self, other: ScheduledProcess, item: ScheduledProcess) -> bool:
        """Whether a process can preempt another one wherever that does not hold a semaphore and is interruptible."""
        if other.is_isr != item.is_isr:
            return other.is_isr
        if other.rank <= item.rank or preemption(item) is Preemption.NON_PREEMPTIVE:
            return False
        if item.group is not None and other.rank <= self._ceilings[item.group]:
            return False
        return not (preemption(item) is preemption(other) is Preemption.COOPERATIVE)

    def always_preempts(self, other: ScheduledProcess, item: ScheduledProcess) -> bool:
        """Whether a process can preempt another one at any point of its jobs, and never waits for anything."""
        uses, of_other = self.protection[item.name], self.protection[other.name].semaphores
        return (
            self.preempts(other, item)
            and not uses.has_non_interruptible_group
            and all(self._ceilings[name] < other.rank for name in uses.semaphores)
            and self.open_semaphores.isdisjoint(of_other)
        )

    def last_region(self, item: ScheduledProcess) -> Time:
        """The demand after the last point at which others of its kind can run, where that point is as late as possible."""
        whole = self.demand_model.of_process(item.process, item.core).worst
        if preemption(item) is Preemption.NON_PREEMPTIVE:
            return whole
        found = self._of(item, KeptOff(throughout=True, yields_after_calls=item.group is None))
        return found.total if found.before_last is None else max(0, found.total - found.before_last)

    def under_deadlines(self, item: ScheduledProcess) -> BlockingByDeadline:
        """The blocking of a process by others of its rank and below, under earliest deadline first."""
        level = self.level(item)
        together = [other for other in self.processes if other.rank == item.rank]
        deadlines = sorted({other.deadline or 0 for other in together})
        steps = []
        for deadline in deadlines:
            above = [other for other in self.processes if other.rank > level.rank]
            above += [other for other in together if (other.deadline or 0) <= deadline]
            steps.append(
                (
                    deadline,
                    tuple(
                        (other.deadline if other.rank == item.rank else None, self.longest_stretch(other, above))
                        for other in self.processes
                        if other is not item and other.rank <= item.rank and other.name not in self.unknown
                    ),
                )
            )
        return BlockingByDeadline(tuple(steps))

    def _of(self, item: ScheduledProcess, kept_off: KeptOff) -> Stretches:
        key = (item.name, kept_off)
        if key not in self._stretches:

            def demand_of(activity: Activity) -> Time:
                return self.demand_model.of_activities(item.process, (activity,), item.core).worst

            model = self.demand_model
            walk = StretchWalk(model.system, kept_off, demand_of, model.possible_branches)
            self._stretches[key] = walk.of(item.process.activities)
        return self._stretches[key]


@dataclass(frozen=True, slots=True)
class BlockingByDeadline:
    """Blocking under earliest deadline first: by jobs with later deadlines, of jobs with earlier ones.

    Only a job whose deadline is later than that of the job in question blocks, with a stretch in which it keeps off any process with an
    earlier one that belongs to the busy window (Baker 1991; M. Spuri, INRIA RR-2772, 1996).

    Attributes
    ----------
    steps : relative deadline up to which processes are kept off; for each blocking process its relative deadline (None: later than
        all) and its longest stretch
    """

    steps: tuple[tuple[Time, tuple[tuple[Time | None, Time], ...]], ...]

    @property
    def is_empty(self) -> bool:
        """Whether nothing blocks."""
        return not any(length for _, stretches in self.steps for _, length in stretches)

    def before(self, deadline: Time) -> Time:
        """The blocking of a job whose deadline is at a time after the start of the busy window."""
        found = 0
        for limit, stretches in self.steps:
            if limit <= deadline:
                later = (length for blocking, length in stretches if blocking is None or blocking > deadline)
                found = max([found, *later])
        return found


def _can_be_preempted(item: ScheduledProcess) -> bool:
    return preemption(item) is Preemption.COOPERATIVE and item.group is None
