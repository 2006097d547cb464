"""Which core or server executes a process, by which policy and with which rank.

Hierarchies of schedulers are read as in the help of APP4MC on hierarchical scheduling: the parent decides first, by the parameters of
the association; its children decide only while they are served. The priorities of all levels form a rank that is compared from the
left. Below a server, everything shares the server's budget.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum

from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.os import Duration, Parameter, ParameterValue, Policy, Scheduler
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Periodic
from amalthea_uros.perf.system import System
from amalthea_uros.timing.notes import Notes
from amalthea_uros.units import Time

#: Policies that serve the highest priority first.
BY_PRIORITY = {Policy.FIXED_PRIORITY_PREEMPTIVE, Policy.OSEK, Policy.PRIORITY_BASED_ROUND_ROBIN}
#: Policies that grant a budget in each period.
SERVERS = {
    Policy.DEFERRABLE_SERVER,
    Policy.POLLING_SERVER,
    Policy.SPORADIC_SERVER,
    Policy.CONSTANT_BANDWIDTH_SERVER,
    Policy.CONSTANT_BANDWIDTH_SERVER_WITH_CASH,
}
#: Other names of policies, in small letters; since AMALTHEA 2.0 a policy is known by nothing else than its name.
ALIASES = {
    "fpp": Policy.FIXED_PRIORITY_PREEMPTIVE,
    "fixed priority preemptive": Policy.FIXED_PRIORITY_PREEMPTIVE,
    "autosar": Policy.OSEK,
    "edf": Policy.EARLIEST_DEADLINE_FIRST,
    "deadline monotonic": Policy.DEADLINE_MONOTONIC,
    "rate monotonic": Policy.RATE_MONOTONIC,
}
#: Names of the parameters of servers: those of the standard definitions, and those of AMALTHEA until 1.2.
CAPACITY = ("capacity", "maxBudget")
PERIOD = ("period", "replenishment")

#: Who is served first, compared from the left: interrupts before tasks, then the priorities of one scheduler after the other.
Rank = tuple[int, ...]


class EqualPriority(StrEnum):
    """Who of the same priority is served first."""

    FIFO = "first come, first served"
    EDF = "earliest deadline first"
    ROUND_ROBIN = "round robin"


@dataclass(frozen=True, slots=True, kw_only=True)
class SchedulingContext:
    """How something is scheduled.

    Attributes
    ----------
    server : whose budget it uses; None: no server's
    rank : higher is served first
    equal_priority, slice : how tasks of the same rank share the core
    group : its members do not preempt each other
    """

    core: str = ""
    server: str | None = None
    rank: Rank = (0,)
    equal_priority: EqualPriority = EqualPriority.FIFO
    deadline: Time | None = None
    slice: Time = 0
    group: str | None = None

    @property
    def urgency(self) -> Rank:
        """The rank with the deadline, where that decides."""
        return (*self.rank, -(self.deadline or 0)) if self.equal_priority is EqualPriority.EDF else self.rank


@dataclass(frozen=True, slots=True, kw_only=True)
class ScheduledProcess(SchedulingContext):
    """A process on a core."""

    process: Process
    is_isr: bool
    priority: int | None

    @property
    def name(self) -> str:
        """That of the process."""
        return self.process.name


@dataclass(frozen=True, slots=True, kw_only=True)
class Server(SchedulingContext):
    """A scheduler that gets a budget in each period, and serves others with it."""

    scheduler: Scheduler
    budget: Time
    period: Time

    @property
    def name(self) -> str:
        """That of the scheduler."""
        return self.scheduler.name


class NotSchedulableError(Exception):
    """It is not known how a process is served; the text says why."""


@dataclass(frozen=True, slots=True)
class _Given:
    """The parameters of a process or scheduler for the scheduler above it."""

    priority: int | None
    deadline: Time | None
    period: Time | None
    parameters: Sequence[Parameter]

    def of(self, scheduler: Scheduler, *names: str) -> ParameterValue | None:
        """The value of the first parameter of some names that is stated, here or for all of the scheduler."""
        stated = {p.name: p.values[0] for p in (*scheduler.parameters, *self.parameters) if len(p.values) == 1}
        return next((stated[name] for name in names if name in stated), None)


@dataclass(slots=True)
class Scheduling:
    """Finds out how processes are scheduled.

    Attributes
    ----------
    limits : of response times by requirements, which are deadlines where no others are stated
    """

    system: System
    notes: Notes
    limits: Mapping[str, Time] = field(default_factory=dict)
    servers: dict[str, Server] = field(default_factory=dict)

    def task(self, allocation: TaskAllocation) -> ScheduledProcess:
        """The place of a task.

        Raises
        ------
        NotSchedulableError : there is no analysis for how it is scheduled.
        """
        process = self.system.processes.get(allocation.task)
        scheduler = self.system.schedulers.get(allocation.scheduler)
        if process is None or scheduler is None:
            raise NotSchedulableError("its task or scheduler is not part of the model")
        deadline = self.limits.get(process.name) if allocation.deadline is None else allocation.deadline
        given = _Given(allocation.priority, deadline, self._period(process), allocation.parameters)
        found = self._under(scheduler, given, ())
        return ScheduledProcess(
            process=process,
            core=self._core(scheduler, allocation.cores),
            server=found.server,
            is_isr=False,
            priority=allocation.priority,
            deadline=deadline,
            rank=found.rank,
            equal_priority=found.equal_priority,
            slice=found.slice,
            group=found.group,
        )

    def _period(self, process: Process) -> Time | None:
        stimuli = [self.system.stimuli_by_name.get(name) for name in process.stimuli]
        return min((stimulus.period for stimulus in stimuli if isinstance(stimulus, Periodic)), default=None)

    def _under(self, scheduler: Scheduler, given: _Given, above: tuple[str, ...]) -> SchedulingContext:
        """The place of what is given to a scheduler."""
        if scheduler.name in above:
            raise NotSchedulableError("its schedulers are below each other in a circle")
        above = (*above, scheduler.name)
        policy = self._policy(scheduler)
        if policy == Policy.GROUPING:
            return self._in_group(scheduler, given, above)
        if policy in SERVERS:
            server = self._server(scheduler, above)
            return SchedulingContext(server=server.name, rank=() if given.priority is None else (given.priority,))
        base = self._of_scheduler(scheduler, above)
        if base.equal_priority is not EqualPriority.FIFO:
            self.notes.warning("ANA002", f"there is no analysis for {scheduler.name!r} below {base.equal_priority}", scheduler)
            raise NotSchedulableError(f"there is no analysis for schedulers below {base.equal_priority}")
        if policy is None:
            message = f"the scheduler {scheduler.name!r} names no policy, fixed priorities with preemption are taken"
            self.notes.warning("ANA001", message, scheduler)
        by_policy = _BY_POLICY.get(policy)
        if by_policy is None:
            message = f"there is no analysis for the policy {policy!r} of the scheduler {scheduler.name!r}"
            self.notes.warning("ANA002", message, scheduler)
            raise NotSchedulableError(f"there is no analysis for the policy {policy}")
        return by_policy(scheduler, given, base)

    def _policy(self, scheduler: Scheduler) -> str | None:
        """The policy of a scheduler by its standard name."""
        meant = ALIASES.get((scheduler.policy or "").lower())
        if meant is None:
            return scheduler.policy
        self.notes.assume(f"the policy {scheduler.policy!r} is taken for {meant}")
        return meant

    def _in_group(self, scheduler: Scheduler, given: _Given, above: tuple[str, ...]) -> SchedulingContext:
        """A grouping decides nothing: its parent does, by what is stated for the process, or else for the whole group."""
        if scheduler.parent is None:
            raise NotSchedulableError(f"the grouping {scheduler.name!r} has no scheduler above it")
        parent, whole = self._parent(scheduler)
        merged = _Given(
            priority=whole.priority if given.priority is None else given.priority,
            deadline=whole.deadline if given.deadline is None else given.deadline,
            period=given.period,
            parameters=(*whole.parameters, *given.parameters),
        )
        return self._under(parent, merged, above)

    def _of_scheduler(self, scheduler: Scheduler, above: tuple[str, ...]) -> SchedulingContext:
        """The place of a scheduler itself, in front of which those of what it serves come."""
        if scheduler.parent is None:
            return SchedulingContext()
        parent, given = self._parent(scheduler)
        if scheduler.policy not in SERVERS and self._is_shared(parent, given.priority):
            message = f"the priority of {scheduler.name!r} in {parent.name!r} is that of others, too"
            self.notes.warning("ANA002", message, scheduler)
            raise NotSchedulableError("there is no analysis for schedulers that share a priority")
        return self._under(parent, given, above)

    def _parent(self, scheduler: Scheduler) -> tuple[Scheduler, _Given]:
        assert scheduler.parent is not None
        parent = self.system.schedulers.get(scheduler.parent.scheduler)
        if parent is None:
            raise NotSchedulableError(f"the scheduler above {scheduler.name!r} is not part of the model")
        stated = scheduler.parent
        period = _time(_Given(None, None, None, stated.parameters).of(scheduler, *PERIOD))
        deadline = period if stated.deadline is None else stated.deadline
        return parent, _Given(stated.priority, deadline, period, stated.parameters)

    def _is_shared(self, parent: Scheduler, priority: int | None) -> bool:
        """Whether more than one scheduler or task has a priority, where the priority decides."""
        if parent.policy not in BY_PRIORITY | SERVERS:
            return False
        children = [s for s in self.system.schedulers.values() if s.parent is not None and s.parent.scheduler == parent.name]
        priorities = [child.parent.priority for child in children if child.parent is not None]
        priorities += [task.priority for task in self.system.mapping.tasks if task.scheduler == parent.name]
        return priorities.count(priority) > 1

    def _server(self, scheduler: Scheduler, above: tuple[str, ...]) -> Server:
        if scheduler.name not in self.servers:
            found = self._of_scheduler(scheduler, above)
            stated = _Given(None, None, None, scheduler.parent.parameters if scheduler.parent else ())
            self.servers[scheduler.name] = Server(
                scheduler=scheduler,
                budget=_needed(_time(stated.of(scheduler, *CAPACITY)), "capacity"),
                period=_needed(_time(stated.of(scheduler, *PERIOD)), "period"),
                core=self._core(scheduler, ()),
                server=found.server,
                rank=found.rank,
                equal_priority=found.equal_priority,
                deadline=found.deadline,
                slice=found.slice,
            )
        return self.servers[scheduler.name]

    def _core(self, scheduler: Scheduler, wanted: tuple[str, ...]) -> str:
        root, served = scheduler, scheduler.cores
        while root.parent is not None and root.parent.scheduler in self.system.schedulers:
            root = self.system.schedulers[root.parent.scheduler]
            served = served or root.cores
        cores = [core for core in served if core in wanted] if wanted else list(served)
        if len(cores) != 1:
            why = "several cores serve it" if cores else "no core serves it"
            message = f"the scheduler {scheduler.name!r} decides for {len(served)} cores; only one per task is analysed"
            self.notes.warning("ANA002", message, scheduler)
            raise NotSchedulableError(why)
        roots = [s.name for s in self.system.schedulers.values() if s.parent is None and cores[0] in s.cores]
        others = [name for name in roots if name != root.name]
        if others:
            message = f"the core {cores[0]!r} is served by {root.name!r} and by {others[0]!r}"
            self.notes.warning("ANA002", message, scheduler)
            raise NotSchedulableError("two schedulers share its core")
        return cores[0]

    def isr(self, name: str, controller_name: str, priority: int | None) -> ScheduledProcess:
        """The place of an interrupt service routine; raises as `task`."""
        process = self.system.processes.get(name)
        controller = self.system.interrupt_controllers.get(controller_name)
        if process is None or controller is None:
            raise NotSchedulableError("its controller is not part of the model")
        if len(controller.cores) != 1:
            raise NotSchedulableError("several cores serve it" if controller.cores else "no core serves it")
        rank = (1, priority or 0)
        return ScheduledProcess(process=process, core=controller.cores[0], is_isr=True, priority=priority, rank=rank)


def _time(value: ParameterValue | None) -> Time | None:
    return value.time if isinstance(value, Duration) else None


def _needed(value: int | None, what: str) -> int:
    """A value that may not be missing, and no time that may not be 0."""
    if value is None or (what != "priority" and value <= 0):
        raise NotSchedulableError(f"it has no {what}")
    return value


# Policies


def _fixed_priority(_scheduler: Scheduler, given: _Given, base: SchedulingContext) -> SchedulingContext:
    return replace(base, rank=(*base.rank, _needed(given.priority, "priority")))


def _osek(scheduler: Scheduler, given: _Given, base: SchedulingContext) -> SchedulingContext:
    found, group = _fixed_priority(scheduler, given, base), given.of(scheduler, "taskGroup")
    return found if group is None else replace(found, group=f"{scheduler.name}/{group}")


def _round_robin(scheduler: Scheduler, given: _Given, base: SchedulingContext) -> SchedulingContext:
    found = _fixed_priority(scheduler, given, base)
    length = _needed(_time(given.of(scheduler, "timeSliceLength")), "timeSliceLength")
    return replace(found, equal_priority=EqualPriority.ROUND_ROBIN, slice=length)


def _deadline_monotonic(_scheduler: Scheduler, given: _Given, base: SchedulingContext) -> SchedulingContext:
    return replace(base, rank=(*base.rank, -_needed(given.deadline, "deadline")))


def _rate_monotonic(scheduler: Scheduler, given: _Given, base: SchedulingContext) -> SchedulingContext:
    stated = _time(given.of(scheduler, "period")) or given.period
    return replace(base, rank=(*base.rank, -_needed(stated, "period")))


def _earliest_deadline_first(_scheduler: Scheduler, given: _Given, base: SchedulingContext) -> SchedulingContext:
    return replace(base, equal_priority=EqualPriority.EDF, deadline=_needed(given.deadline, "deadline"))


#: How a scheduler of each policy treats what is below it; without a policy, fixed priorities are assumed.
_BY_POLICY: Mapping[str | None, Callable[[Scheduler, _Given, SchedulingContext], SchedulingContext]] = {
    None: _fixed_priority,
    Policy.FIXED_PRIORITY_PREEMPTIVE: _fixed_priority,
    Policy.OSEK: _osek,
    Policy.PRIORITY_BASED_ROUND_ROBIN: _round_robin,
    Policy.DEADLINE_MONOTONIC: _deadline_monotonic,
    Policy.RATE_MONOTONIC: _rate_monotonic,
    Policy.EARLIEST_DEADLINE_FIRST: _earliest_deadline_first,
}
