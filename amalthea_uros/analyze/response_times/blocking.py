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

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.perf.software import Preemption
from amalthea_uros.timing.blocking.critical_sections import LockUsage
from amalthea_uros.timing.blocking.regions import NonPreemptiveRegions, ProcessRegions, RegionKind
from amalthea_uros.timing.demand.model import DemandModel
from amalthea_uros.timing.scheduling.scheduled import (
    EqualPriority,
    Rank,
    ScheduledProcess,
    SchedulingContext,
    is_below,
    preemption,
)
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.solution import Solution


@dataclass(frozen=True, slots=True)
class InterferenceLevel:
    """The processes that interfere with a process: those of at least a rank.

    Attributes
    ----------
    is_flat : whether those of the lowest ranks are served in any order, so that all of them interfere
    """

    rank: Rank
    is_flat: bool = False


@dataclass(frozen=True, slots=True)
class _Above:
    """What matters of the processes of a level to those below.

    Attributes
    ----------
    lowest : their lowest rank
    has_task : whether they include tasks, which wait for non-preemptive ones
    has_waiting : whether they include tasks that wait for cooperative ones
    semaphores : that they use
    """

    lowest: Rank
    has_task: bool
    has_waiting: bool
    semaphores: frozenset[str]


@dataclass(slots=True)
class Blocking:
    """The processes of a core, or of a server, that may block each other.

    Attributes
    ----------
    protection : what each process uses to keep others off
    unknown : processes whose demand or locks are unknown
    open_semaphores : those whose users can wait for somebody who does not run at the ceiling
    is_possible : whether any process is not preempted in some part of its jobs
    """

    processes: Sequence[ScheduledProcess]
    stretches: ProcessRegions
    protection: Mapping[str, LockUsage]
    unknown: frozenset[str] = frozenset()
    open_semaphores: frozenset[str] = frozenset()
    is_possible: bool = field(init=False)
    _ceilings: dict[str, Rank] = field(default_factory=dict)
    _levels: dict[Rank, InterferenceLevel] = field(default_factory=dict)
    _of_ranks: dict[Rank, _Above] = field(default_factory=dict)

    @classmethod
    def of(cls, processes: Sequence[ScheduledProcess], solution: Solution) -> Blocking:
        """The blocking among processes of a core, or of a server."""
        context = solution.context
        unknown = frozenset(item.name for item in processes if not solution.is_analysable(item.name))
        return cls(processes, context.stretches, context.protection, unknown, context.open_semaphores)

    def __post_init__(self) -> None:
        self.is_possible = any(map(self.keeps_off_others, self.processes))
        for item in self.processes:
            for name in self._exclusions(item):
                self._ceilings[name] = max(self._ceilings.get(name, item.rank), item.rank)

    @property
    def demand_model(self) -> DemandModel:
        """Converts activities to execution demand."""
        return self.stretches.demand_model

    def _exclusions(self, item: ScheduledProcess) -> Iterator[str]:
        """The semaphores that a process uses, and its group."""
        yield from self.protection[item.name].semaphores
        if item.group is not None:
            yield item.group

    def keeps_off_others(self, item: ScheduledProcess) -> bool:
        """Whether a process is not preempted in some part of its jobs."""
        uses = self.protection[item.name]
        is_preemptive = preemption(item) is Preemption.PREEMPTIVE and item.group is None
        return not is_preemptive or bool(uses.semaphores) or uses.has_non_interruptible_group

    def is_below(self, other: SchedulingContext, item: SchedulingContext) -> bool:
        """Whether something is never served before an item: its rank is lower or, where nothing blocks, its place in the same one."""
        return other.rank < item.rank or (not self.is_possible and is_below(other.place, item.place))

    def level(self, item: SchedulingContext) -> InterferenceLevel:
        """The level of the busy window of a process or server."""
        if item.rank not in self._levels:
            self._levels[item.rank] = self._level(item) if self.is_possible else InterferenceLevel(item.rank)
        return self._levels[item.rank]

    def _level(self, item: SchedulingContext) -> InterferenceLevel:
        rank = item.rank
        while True:
            above = self._above(rank)
            lowest = min([rank, *self._holders(above), *self._between(above)])
            if lowest == rank:
                return InterferenceLevel(rank, self._is_flat(item, rank, above))
            rank = lowest

    def _above(self, rank: Rank) -> _Above:
        """The processes of at least a rank."""
        if rank not in self._of_ranks:
            self._of_ranks[rank] = self._summary(other for other in self.processes if other.rank >= rank)
        return self._of_ranks[rank]

    def _summary(self, processes: Iterable[ScheduledProcess]) -> _Above:
        found = list(processes)
        tasks = [item for item in found if not item.is_isr]
        return _Above(
            lowest=min(item.rank for item in found),
            has_task=bool(tasks),
            has_waiting=any(preemption(item) is not Preemption.PREEMPTIVE for item in tasks),
            semaphores=frozenset(name for item in found for name in self.protection[item.name].semaphores),
        )

    def _holders(self, above: _Above) -> Iterator[Rank]:
        """The ranks of processes for which some others wait at a semaphore without a ceiling."""
        awaited = self.open_semaphores & above.semaphores
        if awaited:
            yield from (
                other.rank for other in self.processes if not awaited.isdisjoint(self.protection[other.name].semaphores)
            )

    def _between(self, above: _Above) -> Iterator[Rank]:
        """The ranks of tasks that preempt a cooperative one of lower rank while it keeps off one of a higher rank."""
        below = [other for other in self.processes if other.rank < above.lowest]
        cooperative = (other for other in below if preemption(other) is Preemption.COOPERATIVE and other.group is None)
        blocking = [other.rank for other in cooperative if self._throughout(other, above)]
        if blocking:
            lowest = min(blocking)
            yield from (
                other.rank for other in below if other.rank > lowest and preemption(other) is not Preemption.COOPERATIVE
            )

    def _is_flat(self, item: SchedulingContext, rank: Rank, above: _Above) -> bool:
        if not self.open_semaphores.isdisjoint(above.semaphores):
            return True
        together = [other for other in self.processes if other.rank == item.rank]
        if len(together) < 2:
            return False
        match item.equal_priority:
            case EqualPriority.UNKNOWN:
                return True
            case EqualPriority.ROUND_ROBIN | EqualPriority.TIME_SLICES:
                # A task that cannot be preempted keeps the core for longer than its slice.
                return rank < item.rank or any(map(self.keeps_off_others, together))
            case EqualPriority.EDF:
                kinds = {preemption(other) is Preemption.COOPERATIVE for other in together}
                return rank < item.rank or len(kinds) > 1
        return rank < item.rank

    def time(self, item: SchedulingContext) -> Time:
        """The maximum time for which a process below the level of a process or server keeps it off."""
        return max((length for _, length in self.stretches_below(self.level(item))), default=0) if self.is_possible else 0

    def stretches_below(self, level: InterferenceLevel) -> Iterator[tuple[ScheduledProcess, Time]]:
        """The longest stretch of each process below a level in which it keeps off one of the level."""
        above = self._above(level.rank)
        for other in self.processes:
            if other.rank < level.rank and other.name not in self.unknown:
                yield other, self._longest_stretch(other, above, self._up_to_ceiling(other, above))

    def obstacle(self, item: SchedulingContext) -> str:
        """A process of lower priority that can delay a process or server for an unknown time; "" if there is none."""
        level = self.level(item)
        above = self._above(level.rank)
        below = (other for other in self.processes if other.name in self.unknown and other.rank < item.rank)
        return next((other.name for other in below if other.rank >= level.rank or self._may_keep_off(other, above)), "")

    def _may_keep_off(self, other: ScheduledProcess, above: _Above) -> bool:
        return (
            self.protection[other.name].has_non_interruptible_group
            or self._throughout(other, above)
            or any(self._ceilings[name] >= above.lowest for name in self._exclusions(other))
        )

    def _up_to_ceiling(self, other: ScheduledProcess, above: _Above) -> Iterable[str]:
        """The semaphores with which a process keeps off others: all up to the ceiling, also those that do not use it."""
        return (name for name in self.protection[other.name].semaphores if self._ceilings[name] >= above.lowest)

    def _longest_stretch(self, other: ScheduledProcess, above: _Above, semaphores: Iterable[str]) -> Time:
        """The longest region of a process in which it blocks one of some processes, by semaphores and otherwise."""
        if not self.keeps_off_others(other):
            return 0
        if preemption(other) is Preemption.NON_PREEMPTIVE and self._throughout(other, above):
            return self.demand_model.of_process(other.process, other.core).worst
        in_group = other.group is not None and self._ceilings[other.group] >= above.lowest
        throughout, uses = self._throughout(other, above), self.protection[other.name]
        if not (throughout or uses.semaphores or uses.has_non_interruptible_group):
            return 0
        kept_off = RegionKind(
            frozenset(semaphores) - self.open_semaphores,
            throughout=throughout,
            yields_after_calls=not in_group and preemption(other) is Preemption.COOPERATIVE,
        )
        return self._of(other, kept_off).longest

    def _throughout(self, other: ScheduledProcess, above: _Above) -> bool:
        """Whether a process blocks one of some processes everywhere, apart from points at which it yields."""
        if other.group is not None and above.lowest <= self._ceilings[other.group]:
            return True
        match preemption(other):
            case Preemption.NON_PREEMPTIVE:
                return above.has_task
            case Preemption.COOPERATIVE:
                return above.has_waiting
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

    def prevents_start(self, one: ScheduledProcess, other: ScheduledProcess) -> bool:
        """Whether a process, as long as it is ready, keeps another one of the core from starting, if not from continuing."""
        if one.core != other.core or one.server or other.server or one.rank <= other.rank:
            return False
        # While something below keeps the first one off, or it waits for that, the other one can start.
        return self.level(one).rank > other.rank

    def interrupts(self, one: ScheduledProcess, other: ScheduledProcess) -> bool:
        """Whether a process, once it is ready, preempts another one at once and delays it until its own end."""
        return self.prevents_start(one, other) and self.always_preempts(one, other)

    def last_region(self, item: ScheduledProcess) -> Time:
        """The demand after the last point at which others of its kind can run, where that point is as late as possible."""
        if preemption(item) is Preemption.NON_PREEMPTIVE:
            return self.demand_model.of_process(item.process, item.core).worst
        found = self._of(item, RegionKind(throughout=True, yields_after_calls=item.group is None))
        return found.total if found.before_last is None else max(0, found.total - found.before_last)

    def under_deadlines(self, item: ScheduledProcess) -> BlockingByDeadline:
        """The blocking of a process by others of its rank and below, under earliest deadline first."""
        others = [other for other in self.processes if other is not item and other.rank <= item.rank]
        others = [other for other in others if other.name not in self.unknown]
        together = [other for other in self.processes if other.rank == item.rank]
        higher = [other for other in self.processes if other.rank > item.rank]
        steps = []
        for deadline in sorted({other.deadline or 0 for other in together}):
            above = self._summary([*higher, *(other for other in together if (other.deadline or 0) <= deadline)])
            stretches = tuple(
                (other.deadline, self._longest_stretch(other, above, above.semaphores & self.protection[other.name].semaphores))
                if other.rank == item.rank
                else (None, self._longest_stretch(other, above, self._up_to_ceiling(other, above)))
                for other in others
            )
            steps.append((deadline, stretches))
        return BlockingByDeadline(tuple(steps))

    def _of(self, item: ScheduledProcess, kept_off: RegionKind) -> NonPreemptiveRegions:
        return self.stretches.of(item.process, item.core, kept_off)


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
