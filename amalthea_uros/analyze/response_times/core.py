"""The response times of the processes of one core, by the method that fits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby

from amalthea_uros.analyze.response_times import non_preemptive, priority_levels, schedule
from amalthea_uros.analyze.response_times.blocking import Blocking
from amalthea_uros.analyze.response_times.supply import FULL, Budget, Supply
from amalthea_uros.analyze.response_times.task import Task
from amalthea_uros.analyze.results import Claim, Response
from amalthea_uros.analyze.solution import Solution
from amalthea_uros.perf.os import Policy
from amalthea_uros.perf.software import Preemption
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.event_models import EventModel, Periodic, rescaled
from amalthea_uros.timing.multiframe import MultiframeDemand
from amalthea_uros.timing.preemption import is_preemptive, preemption
from amalthea_uros.timing.releases import known_releases
from amalthea_uros.timing.scheduling import EqualPriority, Rank, ScheduledProcess, Server
from amalthea_uros.units import Time


def responses_on(core: str, solution: Solution) -> dict[str, Response]:
    """The response times on a core, in picoseconds, as far as they can be known."""
    found = _Core(solution, core).responses(None, FULL)
    return {name: in_picoseconds(response, solution.context.demand_model.time_base(core)) for name, response in found.items()}


@dataclass(frozen=True, slots=True)
class _Core:
    solution: Solution
    core: str

    @property
    def context(self) -> TimingContext:
        return self.solution.context

    @property
    def time_base(self) -> int:
        """Parts of a picosecond in which everything here is counted."""
        return self.context.demand_model.time_base(self.core)

    def responses(self, server: str | None, supply: Supply) -> dict[str, Response]:
        """Of those on the core itself, or on the budget of a server, and of all below them."""
        here = self.context.served(self.core, server)
        usable = self._analysable(here)
        placed = [item for item in usable if isinstance(item, ScheduledProcess)]
        is_all = len(placed) == len(here) and supply is FULL
        found = self.exact(placed) if is_all else None
        if found is None:
            found = self.bounds(usable, [item for item in here if isinstance(item, ScheduledProcess)], supply)
        by_name = {item.name: response for item, response in zip(usable, found, strict=True)}
        for item in usable:
            if isinstance(item, Server):
                by_name |= self._inside(item, by_name.pop(item.name))
        return by_name

    def _analysable(self, here: Sequence[ScheduledProcess | Server]) -> list[ScheduledProcess | Server]:
        """Those that do not depend on anything unknown of the same or a higher rank; the others are marked unknown."""
        found: list[ScheduledProcess | Server] = []
        unanalysable = self.context.unanalysable_cores
        culprit: str | None = None
        for (is_isr, _), group in groupby(here, key=lambda item: (_is_isr(item), item.rank)):
            level = list(group)
            culprit = culprit or unanalysable.get((self.core, True))
            if not is_isr:
                culprit = culprit or unanalysable.get((self.core, False))
            culprit = culprit or next((item.name for item in level if not self._is_known(item)), None)
            if culprit is None:
                found += level
            else:
                for item in level:
                    self._mark_unknown(item, f"too little is known of {culprit!r}, which may come before it")
        return found

    def _is_known(self, item: ScheduledProcess | Server) -> bool:
        return isinstance(item, Server) or self.solution.is_known(item.name)

    def _mark_unknown(self, item: ScheduledProcess | Server, reason: str) -> None:
        """Record why nothing can be said about a process, or about all in the budget of a server."""
        if isinstance(item, ScheduledProcess):
            self.solution.mark_unknown(item.name, reason)
        else:
            for inner in self.context.served(item.core, item.name):
                self._mark_unknown(inner, reason)

    def _inside(self, server: Server, response: Response) -> dict[str, Response]:
        """The response times of those on the budget of a server, given when it gets its budget at the latest."""
        budget, period = server.budget * self.time_base, server.period * self.time_base
        if response.worst is None or response.worst > period:
            self._mark_unknown(server, f"the server {server.name!r} is not sure to get its budget in each period")
            return {}
        # A job may come when the budget has just been used up as early as it can be, or when polling has just found nothing.
        used = 0 if server.scheduler.policy == Policy.POLLING_SERVER else budget
        supply = Budget(budget=budget, period=period, wait=period - used + response.worst - budget)
        self.context.notes.assume("of servers no more is known than that they get their budget somewhere in each period")
        return self.responses(server.name, supply)

    def exact(self, here: Sequence[ScheduledProcess]) -> list[Response] | None:
        """By the schedule, where all releases are known and nobody waits for lower priorities."""
        tasks = self.released(here)
        found = schedule.response_times(tasks) if tasks else None
        if found is not None:
            self.context.notes.assume("periodic tasks are released at their offsets; where none is stated, at 0")
        return found

    def released(self, here: Sequence[ScheduledProcess]) -> list[schedule.PeriodicTask]:
        """The processes, if all releases are known, and nobody waits for lower priorities; otherwise nothing."""
        if len({placed.rank for placed in here}) < len(here) or Blocking(here, self.context.demand_model).ceilings:
            return []
        found = [self._released(placed, rank) for rank, placed in enumerate(reversed(here))]
        return [] if None in found else [task for task in reversed(found) if task is not None]

    def _released(self, placed: ScheduledProcess, rank: int) -> schedule.PeriodicTask | None:
        """A process whose releases are all known; None if it is none, or cannot always be interrupted."""
        if not is_preemptive(placed) or placed.name in self.context.decisions:
            return None
        stimulus = known_releases(placed.process, self.context.system)
        if stimulus is None:
            return None
        return schedule.PeriodicTask(
            name=placed.name,
            period=stimulus.period * self.time_base,
            offset=stimulus.offset * self.time_base,
            cost=self.context.demands[placed.name],
            priority=rank,
        )

    def bounds(
        self, usable: Sequence[ScheduledProcess | Server], here: Sequence[ScheduledProcess], supply: Supply
    ) -> list[Response]:
        """By busy windows; who comes lower may block, if its demand is known."""
        notes = self.context.notes
        ranks = sorted({item.rank for item in usable})
        tasks = [self._task(item, ranks) for item in usable]
        blocking = Blocking([item for item in here if item.name in self.context.demands], self.context.demand_model)
        blocking.note_protocols(notes)
        waits = blocking.times()
        if tasks:
            notes.assume("where not all releases on a core are known, all of them may come together at the worst moment")
            notes.assume("best cases there hold once all tasks have been released")
        decisions = self._decisions(len(ranks)) if supply is FULL else []
        found = priority_levels.response_times(
            [*tasks, *decisions], [*(waits.get(item.name, 0) for item in usable), *[0] * len(decisions)], supply
        )
        for index, item in enumerate(usable):
            # Where deadlines or budgets decide, the busy window holds for tasks that cannot be interrupted, too.
            if (
                isinstance(item, ScheduledProcess)
                and not is_preemptive(item)
                and item.equal_priority is EqualPriority.FIFO
                and supply is FULL
            ):
                found[index] = self._to_the_last_region(index, usable, [*tasks, *decisions], blocking, waits)
        # The methods are exact for arrivals that do not know of each other; offsets may keep the worst moment from coming.
        return [replace(response, claim=Claim.BOUND) for response in found[: len(usable)]]

    def _task(self, item: ScheduledProcess | Server, ranks: Sequence[Rank]) -> Task:
        """A process or server as the methods know it; the job of a server is to use its budget."""
        if isinstance(item, Server):
            # Budget that is kept may be used at the end of one period and again at the start of the next one.
            jitter = item.period - item.budget if item.scheduler.policy == Policy.DEFERRABLE_SERVER else 0
            arrivals: EventModel = Periodic(item.period, jitter)
            cost = MultiframeDemand.constant(item.budget * self.time_base)
        else:
            arrivals, cost = self.solution.event_models[item.name], self.context.demands[item.name]
        return Task(
            name=item.name,
            arrivals=rescaled(arrivals, self.time_base),
            cost=cost,
            priority=ranks.index(item.rank),
            equal_priority=item.equal_priority,
            deadline=(item.deadline or 0) * self.time_base if item.equal_priority is EqualPriority.EDF else 0,
            slice=item.slice * self.time_base,
        )

    def _decisions(self, priority: int) -> list[Task]:
        """The decisions of schedulers at the arrivals of tasks, which come before everything else."""
        return [
            Task(
                name=f"decision for {placed.name}",
                arrivals=rescaled(self.solution.event_models[placed.name], self.time_base),
                cost=self.context.decisions[placed.name],
                priority=priority,
            )
            for placed in self.context.on_core(self.core)
            if placed.name in self.context.decisions and placed.name in self.solution.event_models
        ]

    def _to_the_last_region(
        self,
        index: int,
        here: Sequence[ScheduledProcess | Server],
        tasks: Sequence[Task],
        blocking: Blocking,
        waits: Mapping[str, Time],
    ) -> Response:
        """The response time of a task that is not interrupted in its last region, or only by some."""
        placed, task = here[index], tasks[index]
        assert isinstance(placed, ScheduledProcess)
        if preemption(placed) is Preemption.COOPERATIVE:
            sentence = "cooperative tasks are interrupted by preemptive ones at once, by others between runnables"
            self.context.notes.assume(sentence)
        higher = [other for other in tasks if other is not task and other.priority >= task.priority]
        always = [
            tasks[number]
            for number, other in enumerate(here)
            if (tasks[number].priority > task.priority if isinstance(other, Server) else blocking.preempts(other, placed))
        ]
        always += tasks[len(here) :]
        return non_preemptive.response_time(task, higher, waits[placed.name], 1, blocking.last_region(placed), always)


def periodic_tasks(core: str, solution: Solution) -> list[schedule.PeriodicTask]:
    """The tasks of a core whose schedule is known but for execution times; otherwise none."""
    context = solution.context
    here = context.served(core, None)
    processes = [item for item in here if isinstance(item, ScheduledProcess)]
    if len(processes) < len(here) or not all(solution.is_known(item.name) for item in processes):
        return []
    if (core, True) in context.unanalysable_cores or (core, False) in context.unanalysable_cores:
        return []
    return _Core(solution, core).released(processes)


def in_picoseconds(response: Response, time_base: int) -> Response:
    """A response time that was computed in time_base; the greatest values rounded up, the least ones down."""
    if time_base == 1:
        return response
    worst = None if response.worst is None else -(-response.worst // time_base)
    terms = {name: -(-value // time_base) for name, value in response.terms.items()}
    if worst is not None and "interference" in terms:
        # What rounding adds to the terms is taken from the greatest kind of them, so that they still add up.
        terms["interference"] += worst - sum(terms.values())
    return replace(
        response,
        worst=worst,
        best=response.best // time_base,
        window=-(-response.window // time_base),
        completions=tuple(-(-end // time_base) for end in response.completions),
        terms=terms,
    )


def _is_isr(item: ScheduledProcess | Server) -> bool:
    return isinstance(item, ScheduledProcess) and item.is_isr
