"""Response times of all tasks of a core or a server, one priority level after the other, and how blocking changes them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import groupby

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.analyze.response_times import edf, fixed_priority, non_preemptive, round_robin
from amalthea_uros.analyze.response_times.blocking import Blocking
from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.fixed_priority import best_response
from amalthea_uros.analyze.response_times.task import FULL, AnalysedTask, Supply
from amalthea_uros.perf.software import Preemption
from amalthea_uros.timing.basics.notes import AnalysisNotes
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.timing.scheduling.scheduled import (
    EqualPriority,
    Rank,
    ScheduledProcess,
    Server,
    is_below,
    is_preemptive,
    preemption,
)
from amalthea_uros.units import Time

#: The methods for a task among others of its priority, given the tasks of higher priority and the blocking.
METHODS: Mapping[EqualPriority, Callable[[AnalysedTask, Sequence[AnalysedTask], Interference, Time], Response]] = {
    EqualPriority.FIFO: partial(edf.response_time, method=edf.FIFO_METHOD),
    EqualPriority.EDF: edf.response_time,
    EqualPriority.ROUND_ROBIN: round_robin.response_time,
    EqualPriority.TIME_SLICES: round_robin.in_slices,
    EqualPriority.UNKNOWN: fixed_priority.in_any_order,
}


def response_times(
    tasks: Sequence[AnalysedTask], blocking: Sequence[Time] | None = None, supply: Supply = FULL
) -> list[Response]:
    """The response times, in the order of the tasks.

    Parameters
    ----------
    blocking : maximum time that each task waits for one of lower priority; None: 0
    """
    blocking = blocking or [0] * len(tasks)
    order = sorted(range(len(tasks)), key=lambda index: -tasks[index].priority)
    interference = Interference.of_first([tasks[index] for index in order], supply)
    found: dict[int, Response] = {}
    start: Time = 0
    for first, level in _levels(tasks, order):
        higher = interference[first]
        if len(level) == 1:
            (index,) = level
            claim = Claim.BOUND if blocking[index] or supply is not FULL else Claim.EXACT
            found[index], start = fixed_priority.response_time(tasks[index], higher, blocking[index], start, claim)
            continue
        start = 0
        for index in level:
            place = tasks[index].place
            others = [tasks[other] for other in level if other != index and not is_below(tasks[other].place, place)]
            method = METHODS[tasks[index].equal_priority]
            found[index] = method(tasks[index], others, higher, blocking[index])
    return [found[index] for index in range(len(tasks))]


def _levels(tasks: Sequence[AnalysedTask], order: Sequence[int]) -> Iterator[tuple[int, list[int]]]:
    """Each priority, highest first: number of tasks of higher priority, and the tasks of this one."""
    before = 0
    for _, group in groupby(order, key=lambda index: tasks[index].priority):
        level = list(group)
        yield before, level
        before += len(level)


@dataclass(frozen=True, slots=True)
class BlockedWindow:
    """The busy window of a process that others block, or that blocks others itself.

    Attributes
    ----------
    time_base : time units per picosecond
    items, tasks : those on the core or in the server; decisions of schedulers follow in `tasks`
    wait : blocking by processes below its level
    """

    notes: AnalysisNotes
    time_base: int
    blocking: Blocking
    items: Sequence[ScheduledProcess | Server]
    tasks: Sequence[AnalysedTask]
    wait: Time
    supply: Supply

    def response(self, index: int, item: ScheduledProcess | Server, plain: Response) -> Response:
        """The response time of a process, or of the budget of a server; `plain` where each process is preempted at once."""
        if not self.blocking.is_possible:
            return plain
        if isinstance(item, Server):
            return self._of_budget(index, item, plain)
        if item.equal_priority is EqualPriority.TIME_SLICES:
            reason = "what cannot be preempted everywhere may prolong time slices on its core"
            return replace(plain, worst=None, completions=(), terms={}, reason=reason)
        level = self.blocking.level(item)
        task = self.tasks[index]
        higher = self._of_level(index, level.rank)
        if item.equal_priority is EqualPriority.UNKNOWN:
            found = fixed_priority.in_any_order(task, higher, Interference.of([], self.supply), self.wait)
        elif level.is_flat or (level.rank < item.rank and self.supply is not FULL):
            found = fixed_priority.response_time(task, Interference.of(higher, self.supply), self.wait)[0]
        elif item.equal_priority is EqualPriority.EDF:
            found = self._under_deadlines(index, item, plain)
        elif not is_preemptive(item) and item.equal_priority is EqualPriority.FIFO and self.supply is FULL:
            # In servers, the busy window is also valid for non-preemptive tasks.
            found = self._non_preemptive(index, item, higher)
        elif level.rank < item.rank:
            found = fixed_priority.response_time(task, Interference.of(higher, self.supply), self.wait)[0]
        else:
            found = plain
        if found.is_overload and not plain.is_overload:
            # What is below need not delay it each time.
            reason = "processes of lower priority can delay it, and they overload the core"
            found = replace(found, is_overload=False, reason=reason)
        # What only interferes at the lowered level is avoidable.
        return replace(found, best=self._best(index, item, plain.best))

    def _of_budget(self, index: int, server: Server, plain: Response) -> Response:
        """The response time of the budget of a server, which can be preempted at once."""
        level = self.blocking.level(server)
        if level.rank == server.rank and not level.is_flat:
            return plain
        higher = Interference.of(self._of_level(index, level.rank), self.supply)
        return fixed_priority.response_time(self.tasks[index], higher, self.wait)[0]

    def _of_level(self, index: int, rank: Rank) -> list[AnalysedTask]:
        """The other tasks of at least a rank, and the decisions of schedulers."""
        found = [self.tasks[number] for number, other in enumerate(self.items) if number != index and other.rank >= rank]
        return [*found, *self.tasks[len(self.items) :]]

    def _best(self, index: int, item: ScheduledProcess, best: Time) -> Time:
        """The best case: where a job keeps others off, these need not delay it."""
        if not self.blocking.keeps_off_others(item) and not self._any_waits(item):
            return best
        unavoidable = [
            self.tasks[number]
            for number, other in enumerate(self.items)
            if isinstance(other, ScheduledProcess) and self.blocking.always_preempts(other, item)
        ]
        if item.equal_priority is not EqualPriority.FIFO:
            return self.tasks[index].demand.best
        return best_response(self.tasks[index], Interference.of(unavoidable))

    def _any_waits(self, item: ScheduledProcess) -> bool:
        """Whether a process of higher priority can wait for others, so that a lower one runs while it is pending."""
        return any(
            isinstance(other, ScheduledProcess) and other.rank > item.rank and not self.blocking.always_preempts(other, item)
            for other in self.items
        )

    def _under_deadlines(self, index: int, item: ScheduledProcess, plain: Response) -> Response:
        by_deadline = self.blocking.under_deadlines(item)
        if by_deadline.is_empty:
            return plain
        others = [self.tasks[number] for number, other in enumerate(self.items) if number != index and other.rank == item.rank]
        above = [self.tasks[number] for number, other in enumerate(self.items) if other.rank > item.rank]
        higher = Interference.of([*above, *self.tasks[len(self.items) :]], self.supply)
        return edf.response_time(
            self.tasks[index],
            others,
            higher,
            self.wait,
            blocking_before=lambda deadline: by_deadline.before(deadline // self.time_base),
        )

    def _non_preemptive(self, index: int, item: ScheduledProcess, higher: Sequence[AnalysedTask]) -> Response:
        """The response time of a task that only some tasks can preempt in its last region."""
        if preemption(item) is Preemption.COOPERATIVE:
            self.notes.assume(
                "preemptive tasks preempt cooperative ones immediately, cooperative tasks only at schedule points and between calls "
                "of runnables"
            )
        task, last_region = self.tasks[index], self.blocking.last_region(item)
        if not last_region:
            # It yields after its last activity.
            return fixed_priority.response_time(task, Interference.of(higher), self.wait)[0]
        always_preempting = [
            self.tasks[number]
            for number, other in enumerate(self.items)
            if (other.rank > item.rank if isinstance(other, Server) else self.blocking.preempts(other, item))
        ]
        always_preempting += self.tasks[len(self.items) :]
        return non_preemptive.response_time(task, higher, self.wait, 1, last_region, always_preempting)
