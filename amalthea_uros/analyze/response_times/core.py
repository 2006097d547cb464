"""The response times of the processes of one core, by the method that applies."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.analyze.response_times import fixed_priority, priority_levels
from amalthea_uros.analyze.response_times.blocking import Blocking
from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.core_schedule import CoreSchedule, periodic_tasks
from amalthea_uros.analyze.response_times.priority_levels import BlockedWindow
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.response_times.task import FULL, AnalysedTask, Supply
from amalthea_uros.analyze.response_times.waits import beside_waits, shorter_by_segments
from amalthea_uros.perf.os import Policy
from amalthea_uros.perf.software import Preemption
from amalthea_uros.timing.activation.releases import RELEASES
from amalthea_uros.timing.basics.time_base import Ticks, to_ticks
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.event_models.derived import rescaled
from amalthea_uros.timing.event_models.models import EventModel, PeriodicEvents
from amalthea_uros.timing.jobs.executed import ends_with_execution
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.timing.scheduling.scheduled import EqualPriority, Rank, ScheduledProcess, Server, preemption


def responses_on(core: str, solution: Solution) -> dict[str, Response]:
    """The response times on a core, in picoseconds; without processes that could not be analysed."""
    time_base = solution.context.demand_model.time_base(core)
    schedule = _new_schedule(core, solution)
    if schedule is not None:
        solution.context.notes.assume(RELEASES)
        found = schedule.response_times()
    else:
        found = _CoreAnalysis(solution, core).responses(None, FULL)
    return {name: in_picoseconds(response, time_base) for name, response in found.items()}


def _new_schedule(core: str, solution: Solution) -> CoreSchedule | None:
    """The schedules of a core with the present activations, built again only if its tasks have changed."""
    tasks, found = periodic_tasks(core, solution), solution.schedules.pop(core, None)
    if found is None or list(found.tasks.values()) != tasks:
        found = CoreSchedule.of(tasks, with_slices=False) if tasks else None
    if found is not None:
        solution.schedules[core] = found
    return found


@dataclass(frozen=True, slots=True)
class _CoreAnalysis:
    solution: Solution
    core: str

    @property
    def context(self) -> TimingContext:
        return self.solution.context

    @property
    def time_base(self) -> int:
        """Time units per picosecond on this core."""
        return self.context.demand_model.time_base(self.core)

    def responses(self, server: str | None, supply: Supply) -> dict[str, Response]:
        """The response times of processes on the core itself, or in the budget of a server, including those of nested servers."""
        here = self.context.served(self.core, server)
        blocking = self._blocking(here)
        usable, delayed = self._known(here, blocking)
        # What is delayed for an unknown time delays others nevertheless.
        servers = [item for item in here if isinstance(item, Server)]
        delayed |= {item.name for item in usable if self._is_blocked_for_unknown_time(item, blocking, servers)}
        found = self.bounds(usable, blocking, supply)
        by_name = {item.name: response for item, response in zip(usable, found, strict=True) if item.name not in delayed}
        for item in usable:
            if isinstance(item, Server) and item.name not in delayed:
                by_name |= self._inside(item, by_name.pop(item.name))
        return by_name

    def _known(
        self, here: Sequence[ScheduledProcess | Server], blocking: Blocking
    ) -> tuple[list[ScheduledProcess | Server], set[str]]:
        """The known items below no unknown process of a higher rank; the names of all that depend on one, now marked unknown."""
        found: list[ScheduledProcess | Server] = []
        delayed: set[str] = set()
        above = self.solution.intruder(self.core, above_isrs=True)
        for (is_isr, _), group in groupby(
            here, key=lambda item: (isinstance(item, ScheduledProcess) and item.is_isr, item.rank)
        ):
            level = list(group)
            if not is_isr:
                above = above or self.solution.intruder(self.core, above_isrs=False)
            processes = (item for item in level if isinstance(item, ScheduledProcess))
            unknown = [item for item in processes if not self.solution.is_analysable(item.name)]
            for item in level:
                beside = (
                    other.name for other in unknown if not blocking.is_below(other, item) and not _is_apart(item, blocking)
                )
                if cause := above or next(beside, None):
                    self._mark_unknown(item, f"depends on {cause!r}, which could not be analysed")
                    delayed.add(item.name)
            if above is None:
                found += [item for item in level if item not in unknown]
                above = unknown[0].name if unknown else None
        return found, delayed

    def _blocking(self, here: Sequence[ScheduledProcess | Server]) -> Blocking:
        """The blocking on the core itself or in a server; what is in a server waits and keeps others off at the rank of the server."""
        processes = [item for item in here if isinstance(item, ScheduledProcess)]
        for server in here:
            if isinstance(server, Server):
                processes += [
                    replace(item, rank=server.rank, equal_priority=server.equal_priority, group=None)
                    for item in self._processes_in(server)
                ]
        return Blocking.of(processes, self.solution)

    def _is_blocked_for_unknown_time(
        self, item: ScheduledProcess | Server, blocking: Blocking, servers: Sequence[Server]
    ) -> bool:
        """Whether a process can block or delay an item for an unknown time; the item is marked unknown then."""
        obstacle = blocking.obstacle(item) if blocking.unknown else ""
        if obstacle:
            self._mark_unknown(item, f"{obstacle!r}, which could not be analysed, can block it")
        elif isinstance(item, Server) and (obstacle := self._cooperative_below(item, blocking)):
            self._mark_unknown(
                item, f"{obstacle!r} is cooperative, and can block cooperative tasks in the server {item.name!r}"
            )
        for server in servers:
            # What is above the server and waits for a job beyond its budget delays the next budget, too.
            beside = (other for other in self.context.served(self.core, server.server) if other is not server)
            is_touched = server is not item or any(other.rank >= server.rank for other in beside)
            if not obstacle and is_touched and (obstacle := self._not_preempted_in(server)):
                # Whether the end of a budget interrupts it is not standardised: it may go on, before what is above and what is below.
                self._mark_unknown(
                    item,
                    f"{obstacle!r} in the server {server.name!r} cannot be preempted everywhere, and may go on beyond its budget",
                )
        return bool(obstacle)

    def _cooperative_below(self, server: Server, blocking: Blocking) -> str:
        """A cooperative process below a server that has cooperative ones, too; "" if there is none."""
        if not any(preemption(each) is Preemption.COOPERATIVE for each in self._processes_in(server)):
            return ""
        below = (each for each in blocking.processes if each.rank < server.rank)
        return next((each.name for each in below if preemption(each) is Preemption.COOPERATIVE), "")

    def _processes_in(self, server: Server) -> Iterator[ScheduledProcess]:
        """The processes in the budget of a server, and of those within it."""
        for item in self.context.served(self.core, server.name):
            if isinstance(item, Server):
                yield from self._processes_in(item)
            else:
                yield item

    def _not_preempted_in(self, server: Server) -> str:
        """A process in the budget of a server that is not preempted in some part of its jobs; "" if there is none."""
        return next(
            (
                item.name
                for item in self._processes_in(server)
                if preemption(item) is not Preemption.PREEMPTIVE
                or self.context.protection[item.name].has_non_interruptible_group
            ),
            "",
        )

    def _mark_unknown(self, item: ScheduledProcess | Server, reason: str) -> None:
        """Record why a process, or all processes in the budget of a server, cannot be analysed."""
        if isinstance(item, ScheduledProcess):
            self.solution.mark_unknown(item.name, reason)
        else:
            for inner in self.context.served(item.core, item.name):
                self._mark_unknown(inner, reason)

    def _inside(self, server: Server, response: Response) -> dict[str, Response]:
        """The response times in the budget of a server, given the latest time at which it gets its budget."""
        budget, period = server.budget * self.time_base, server.period * self.time_base
        if response.worst is None or response.worst > period:
            self._mark_unknown(server, f"the server {server.name!r} is not guaranteed its budget in each period")
            return {}
        # Worst case: a job is activated just after the budget was used up as early as possible, or just after the server polled.
        used = 0 if server.scheduler.policy == Policy.POLLING_SERVER else budget
        supply = Supply(
            budget=budget,
            period=period,
            wait=period - used + response.worst - budget,
            is_needed_at_end=not self._end_with_execution(server),
        )
        self.context.notes.assume("a server can get its budget at any time within its period")
        return self.responses(server.name, supply)

    def _end_with_execution(self, server: Server) -> bool:
        """Whether the jobs in the budget of a server have nothing left to do once their demand is served."""
        system = self.context.system
        return all(
            self._end_with_execution(item)
            if isinstance(item, Server)
            else ends_with_execution(system.processes[item.name].activities, system)
            for item in self.context.served(self.core, server.name)
        )

    def bounds(self, usable: Sequence[ScheduledProcess | Server], blocking: Blocking, supply: Supply) -> list[Response]:
        """Bounds by busy windows; processes of lower priority can block."""
        notes = self.context.notes
        ranks = sorted({item.rank for item in usable})
        tasks = _without_order_beside_servers([self._task(item, ranks) for item in usable], usable)
        waits = [blocking.time(item) for item in usable]
        if tasks:
            notes.assume("if not all releases on a core are known, all tasks can be released together at the worst moment")
            notes.assume("best cases on such cores hold once all tasks have been released")
        if any(item.equal_priority is EqualPriority.UNKNOWN for item in usable):
            notes.assume(fixed_priority.ASSUMPTION)
        decisions = AnalysedTask.of_decisions(self.core, self.solution, len(ranks)) if supply is FULL else []
        decisions += self._sliced_unknown(usable, ranks)
        found = priority_levels.response_times([*tasks, *decisions], [*waits, *[0] * len(decisions)], supply)
        for index, item in enumerate(usable):
            window = BlockedWindow(notes, self.time_base, blocking, usable, [*tasks, *decisions], waits[index], supply)
            found[index] = window.response(index, item, found[index])
        for index, item in enumerate(usable):
            if found[index].worst is None and isinstance(item, ScheduledProcess) and not _is_apart(item, blocking):
                rank = blocking.level(item).rank
                level = [task for task, other in zip(tasks, usable, strict=False) if other.rank >= rank]
                merged = self._with_longest_paths([*level, *decisions])
                if len(merged) < len(level) + len(decisions):
                    found[index] = fixed_priority.in_busy_period(tasks[index], merged, waits[index], supply, found[index])
        # The methods are exact for independent activations; offsets can make the worst case impossible.
        bounds = [replace(response, claim=Claim.BOUND) for response in found[: len(usable)]]
        if self.context.has_waits(self.core):
            bounds = self._beside_waits(bounds, tasks)
        return [self._without_iterations(item, response) for item, response in zip(usable, bounds, strict=True)]

    def _sliced_unknown(self, usable: Sequence[ScheduledProcess | Server], ranks: Sequence[Rank]) -> Iterator[AnalysedTask]:
        """The unknown processes of which others only need to know the time slice."""
        known = {item.name for item in usable}
        for item in self.context.on_core(self.core):
            if item.equal_priority is EqualPriority.TIME_SLICES and item.rank in ranks and item.name not in known:
                length = item.slice * self.time_base
                yield self._scheduled(item, ranks, PeriodicEvents(length), MultiframeDemand.constant(Ticks(length)))

    def _beside_waits(self, bounds: Sequence[Response], tasks: Sequence[AnalysedTask]) -> list[Response]:
        """The response times on a core with processes that wait for events, which is one without servers and blocking."""
        results = []
        for response, task in zip(bounds, tasks, strict=True):
            waiting = self.context.waiting.get(task.name)
            if waiting is not None:
                others = [other for other in tasks if other is not task and other.priority >= task.priority]
                response = shorter_by_segments(response, task, waiting, Interference.of(others))
            results.append(beside_waits(response, task, waiting))
        return results

    def _with_longest_paths(self, tasks: Sequence[AnalysedTask]) -> list[AnalysedTask]:
        """The tasks, and for those that exclude each other one that takes as long as the longest path of the job that triggers them."""
        found = {task.name: task for task in tasks}
        for together in self.context.triggered_together:
            demands = {name: found[name].demand.worst for name in together.numbers if name in found}
            if len(demands) < 2:
                continue
            longest = together.longest(demands, self.context.activations, self.context.settings.modes)
            if longest < sum(demands.values()):
                members = [found.pop(name) for name in demands]
                demand = MultiframeDemand.constant(Ticks(longest), best=Ticks(0))
                found[members[0].name] = replace(members[0], demand=demand)
        return list(found.values())

    def _without_iterations(self, item: ScheduledProcess | Server, response: Response) -> Response:
        """A response time; an overload is not certain if rounds of executors are counted that need not be as long and as dense."""
        uncertain, here = self.context.with_uncertain_activations, self.context.on_core(item.core)
        if response.is_overload and any(other.name in uncertain and other.rank >= item.rank for other in here):
            reason = f"{response.reason}, if iterations of executors are as long and as frequent as they can be"
            return replace(response, is_overload=False, reason=reason)
        return response

    def _task(self, item: ScheduledProcess | Server, ranks: Sequence[Rank]) -> AnalysedTask:
        """A process or server as the methods see it; a job of a server uses its budget."""
        if isinstance(item, Server):
            # A deferred budget can be used at the end of one period and again at the start of the next one.
            jitter = item.period - item.budget if item.scheduler.policy == Policy.DEFERRABLE_SERVER else 0
            events: EventModel = PeriodicEvents(item.period, jitter)
            # It need not use its budget.
            demand = MultiframeDemand.constant(to_ticks(item.budget, self.time_base), best=Ticks(0))
        else:
            events, demand = self.solution.event_models[item.name], self.context.demands[item.name]
        return self._scheduled(item, ranks, rescaled(events, self.time_base), demand)

    def _scheduled(
        self, item: ScheduledProcess | Server, ranks: Sequence[Rank], events: EventModel, demand: MultiframeDemand
    ) -> AnalysedTask:
        # Who is resumed need not precede those of its priority that came later.
        has_order = not self.context.has_waits(self.core) or item.equal_priority is EqualPriority.TIME_SLICES
        return AnalysedTask(
            name=item.name,
            events=events,
            demand=demand,
            priority=ranks.index(item.rank),
            equal_priority=item.equal_priority if has_order else EqualPriority.UNKNOWN,
            place=item.place,
            deadline=(item.deadline or 0) * self.time_base if item.equal_priority is EqualPriority.EDF else 0,
            slice=item.slice * self.time_base,
            activation_limit=getattr(item.process, "activation_limit", 1) if isinstance(item, ScheduledProcess) else 1,
            is_alone=item.name in self.context.awaited_alone,
        )


def _is_apart(item: ScheduledProcess | Server, blocking: Blocking) -> bool:
    """Whether those of its rank delay a process by their time slices only."""
    return item.equal_priority is EqualPriority.TIME_SLICES and not blocking.is_possible


def in_picoseconds(response: Response, time_base: int) -> Response:
    """A response time computed in the time base of a core, in picoseconds; upper bounds are rounded up, lower bounds down."""
    if time_base == 1:
        return response
    worst = None if response.worst is None else -(-response.worst // time_base)
    terms = {name: -(-value // time_base) for name, value in response.terms.items()}
    if worst is not None and "interference" in terms:
        # Rounding differences are added to the interference, so that the terms still add up.
        terms["interference"] += worst - sum(terms.values())
    return replace(
        response,
        worst=worst,
        best=response.best // time_base,
        window=-(-response.window // time_base),
        completions=tuple(-(-end // time_base) for end in response.completions),
        terms=terms,
    )


def _without_order_beside_servers(
    tasks: Sequence[AnalysedTask], items: Sequence[ScheduledProcess | Server]
) -> list[AnalysedTask]:
    """The tasks; jobs in a server keep their places in the queue of a priority, so that its budgets precede others in any order."""
    with_server = {item.rank for item in items if isinstance(item, Server)}
    return [
        replace(task, equal_priority=EqualPriority.UNKNOWN) if item.rank in with_server else task
        for task, item in zip(tasks, items, strict=True)
    ]
