"""The response times of the processes of one core, by the method that fits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from amalthea_uros.analyze.response_times import non_preemptive, schedule
from amalthea_uros.analyze.response_times import priority_levels as levels
from amalthea_uros.analyze.response_times.blocking import Blocking, is_interruptible, preemption
from amalthea_uros.analyze.response_times.kernel import LIMIT
from amalthea_uros.analyze.response_times.supply import FULL, Budget, Supply
from amalthea_uros.analyze.response_times.task import Claim, Response, Sharing, Task
from amalthea_uros.perf.os import Policy
from amalthea_uros.perf.software import Preemption, Process
from amalthea_uros.perf.stimuli import Periodic
from amalthea_uros.perf.system import System
from amalthea_uros.timing.context import Known
from amalthea_uros.timing.event_models.base import Arrivals, finer
from amalthea_uros.timing.event_models.base import Periodic as PeriodicArrivals
from amalthea_uros.timing.multiframe import Cost
from amalthea_uros.timing.scheduling import Placed, Rank, Server
from amalthea_uros.units import Time


def responses_on(core: str, known: Known) -> dict[str, Response]:
    """The response times on a core, in picoseconds, as far as they can be known."""
    found = _Core(known, core).responses(None, FULL)
    return {name: in_picoseconds(response, known.demands.grains(core)) for name, response in found.items()}


@dataclass(frozen=True, slots=True)
class _Core:
    known: Known
    core: str

    @property
    def grains(self) -> int:
        """Parts of a picosecond in which everything here is counted."""
        return self.known.demands.grains(self.core)

    def responses(self, server: str | None, supply: Supply) -> dict[str, Response]:
        """Of those on the core itself, or on the budget of a server, and of all below them."""
        here = self.known.served(self.core, server)
        usable = self.known.usable(here, self.core)
        placed = [item for item in usable if isinstance(item, Placed)]
        is_all = len(placed) == len(here) and supply is FULL
        found = self.exact(placed) if is_all else None
        if found is None:
            found = self.bounds(usable, [item for item in here if isinstance(item, Placed)], supply)
        by_name = {item.name: response for item, response in zip(usable, found, strict=True)}
        for item in usable:
            if isinstance(item, Server):
                by_name |= self._inside(item, by_name.pop(item.name))
        return by_name

    def _inside(self, server: Server, response: Response) -> dict[str, Response]:
        """The response times of those on the budget of a server, given when it gets its budget at the latest."""
        budget, period = server.budget * self.grains, server.period * self.grains
        if response.worst is None or response.worst > period:
            self.known.give_up_on(server, f"the server {server.name!r} is not sure to get its budget in each period")
            return {}
        # A job may come when the budget has just been used up as early as it can be, or when polling has just found nothing.
        used = 0 if server.scheduler.policy == Policy.POLLING_SERVER else budget
        supply = Budget(budget=budget, period=period, wait=period - used + response.worst - budget)
        self.known.notes.assume("of servers no more is known than that they get their budget somewhere in each period")
        return self.responses(server.name, supply)

    def exact(self, here: Sequence[Placed]) -> list[Response] | None:
        """By the schedule, where all releases are known and nobody waits for lower priorities."""
        tasks = self.released(here)
        found = schedule.response_times(tasks) if tasks else None
        if found is not None:
            self.known.notes.assume("periodic tasks are released at their offsets; where none is stated, at 0")
        return found

    def released(self, here: Sequence[Placed]) -> list[schedule.Released]:
        """The processes, if all releases are known, and nobody waits for lower priorities; otherwise nothing."""
        if len({placed.rank for placed in here}) < len(here) or Blocking(here, self.known.demands).ceilings:
            return []
        found = [self._released(placed, rank) for rank, placed in enumerate(reversed(here))]
        return [] if None in found else [task for task in reversed(found) if task is not None]

    def _released(self, placed: Placed, rank: int) -> schedule.Released | None:
        """A process whose releases are all known; None if it is none, or cannot always be interrupted."""
        if not is_interruptible(placed) or placed.name in self.known.decisions:
            return None
        stimulus = known_releases(placed.process, self.known.system)
        if stimulus is None:
            return None
        return schedule.Released(
            name=placed.name,
            period=stimulus.period * self.grains,
            offset=stimulus.offset * self.grains,
            cost=self.known.costs[placed.name],
            priority=rank,
        )

    def bounds(self, usable: Sequence[Placed | Server], here: Sequence[Placed], supply: Supply) -> list[Response]:
        """By busy windows; who comes lower may block, if its demand is known."""
        notes = self.known.notes
        ranks = sorted({item.rank for item in usable})
        tasks = [self._task(item, ranks) for item in usable]
        blocking = Blocking([item for item in here if item.name in self.known.costs], self.known.demands)
        blocking.note_protocols(notes)
        waits = blocking.times()
        if tasks:
            notes.assume("where not all releases on a core are known, all of them may come together at the worst moment")
            notes.assume("best cases there hold once all tasks have been released")
        decisions = self._decisions(len(ranks)) if supply is FULL else []
        found = levels.response_times(
            [*tasks, *decisions], [*(waits.get(item.name, 0) for item in usable), *[0] * len(decisions)], supply
        )
        for index, item in enumerate(usable):
            # Where deadlines or budgets decide, the busy window holds for tasks that cannot be interrupted, too.
            if isinstance(item, Placed) and not is_interruptible(item) and item.sharing is Sharing.ARRIVAL and supply is FULL:
                found[index] = self._to_the_last_region(index, usable, [*tasks, *decisions], blocking, waits)
        # The methods are exact for arrivals that do not know of each other; offsets may keep the worst moment from coming.
        return [replace(response, claim=Claim.BOUND) for response in found[: len(usable)]]

    def _task(self, item: Placed | Server, ranks: Sequence[Rank]) -> Task:
        """A process or server as the methods know it; the job of a server is to use its budget."""
        if isinstance(item, Server):
            # Budget that is kept may be used at the end of one period and again at the start of the next one.
            jitter = item.period - item.budget if item.scheduler.policy == Policy.DEFERRABLE_SERVER else 0
            arrivals: Arrivals = PeriodicArrivals(item.period, jitter)
            cost = Cost.constant(item.budget * self.grains)
        else:
            arrivals, cost = self.known.arrivals[item.name], self.known.costs[item.name]
        return Task(
            name=item.name,
            arrivals=finer(arrivals, self.grains),
            cost=cost,
            priority=ranks.index(item.rank),
            sharing=item.sharing,
            deadline=(item.deadline or 0) * self.grains if item.sharing is Sharing.DEADLINE else 0,
            slice=item.slice * self.grains,
        )

    def _decisions(self, priority: int) -> list[Task]:
        """The decisions of schedulers at the arrivals of tasks, which come before everything else."""
        return [
            Task(
                name=f"decision for {placed.name}",
                arrivals=finer(self.known.arrivals[placed.name], self.grains),
                cost=self.known.decisions[placed.name],
                priority=priority,
            )
            for placed in self.known.on_core(self.core)
            if placed.name in self.known.decisions and placed.name in self.known.arrivals
        ]

    def _to_the_last_region(
        self,
        index: int,
        here: Sequence[Placed | Server],
        tasks: Sequence[Task],
        blocking: Blocking,
        waits: Mapping[str, Time],
    ) -> Response:
        """The response time of a task that is not interrupted in its last region, or only by some."""
        placed, task = here[index], tasks[index]
        assert isinstance(placed, Placed)
        if preemption(placed) is Preemption.COOPERATIVE:
            sentence = "cooperative tasks are interrupted by preemptive ones at once, by others between runnables"
            self.known.notes.assume(sentence)
        higher = [other for other in tasks if other is not task and other.priority >= task.priority]
        always = [
            tasks[number]
            for number, other in enumerate(here)
            if (tasks[number].priority > task.priority if isinstance(other, Server) else blocking.interrupts(other, placed))
        ]
        always += tasks[len(here) :]
        return non_preemptive.response_time(task, higher, waits[placed.name], 1, blocking.last_region(placed), always)


def released_on(core: str, known: Known) -> list[schedule.Released]:
    """The tasks of a core of which the schedule is known but for execution times; otherwise nothing."""
    here = known.served(core, None)
    placed = [item for item in here if isinstance(item, Placed)]
    if len(placed) < len(here) or not all(item.name in known.costs and item.name in known.arrivals for item in placed):
        return []
    if (core, True) in known.disturbed or (core, False) in known.disturbed:
        return []
    return _Core(known, core).released(placed)


def known_releases(process: Process, system: System) -> Periodic | None:
    """The stimulus of a process that is released at known times; None if it is not."""
    match [system.stimuli_by_name.get(name) for name in process.stimuli]:
        case [Periodic(jitter=None, condition=None, period=period, offset=offset) as stimulus] if (
            0 < period <= LIMIT and 0 <= offset <= LIMIT
        ):
            return stimulus
    return None


def in_picoseconds(response: Response, grains: int) -> Response:
    """A response time that was computed in grains; the greatest values rounded up, the least ones down."""
    if grains == 1:
        return response
    worst = None if response.worst is None else -(-response.worst // grains)
    terms = {name: -(-value // grains) for name, value in response.terms.items()}
    if worst is not None and "interference" in terms:
        # What rounding adds to the terms is taken from the greatest kind of them, so that they still add up.
        terms["interference"] += worst - sum(terms.values())
    return replace(
        response,
        worst=worst,
        best=response.best // grains,
        window=-(-response.window // grains),
        completions=tuple(-(-end // grains) for end in response.completions),
        terms=terms,
    )
