"""Where the processes run and who precedes whom, as one order of levels for the whole system."""

from __future__ import annotations

from collections import Counter
from itertools import product

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.os import SERVERS, Policy
from amalthea_uros.perf.software import Preemption
from amalthea_uros.timing.activation.releases import response_time_limits
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.scheduling.allocation import allocated_cores, standard_policy
from amalthea_uros.timing.scheduling.ranks import SchedulingOrder
from amalthea_uros.timing.scheduling.scheduled import EqualPriority, Rank, ScheduledProcess, Server, preemption


@dataclass(frozen=True, slots=True)
class Dispatched:
    """A process, and the cores that can execute it."""

    scheduled: ScheduledProcess
    cores: tuple[str, ...]

    @property
    def name(self) -> str:
        """The name of the process."""
        return self.scheduled.name


@dataclass(slots=True)
class Dispatching:
    """The scheduling of all processes.

    Attributes
    ----------
    processes : that run somewhere, by name
    left_out : why the others do not
    """

    context: TimingContext
    processes: dict[str, Dispatched] = field(default_factory=dict)
    left_out: dict[str, str] = field(default_factory=dict)
    servers: dict[str, Server] = field(default_factory=dict)
    _levels: dict[Rank, int] = field(default_factory=dict)
    #: Of the tasks of each core: of all of them (None), and of each group.
    _highest: dict[tuple[str, str | None], int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        context = self.context
        system = context.system
        self.servers.update(context.servers)
        counts = Counter(allocation.task for allocation in system.mapping.tasks)
        allocations = {allocation.task: allocation for allocation in system.mapping.tasks}
        for name in system.processes:
            try:
                if counts[name] > 1:
                    raise UnknownError("it is allocated more than once")
                self.processes[name] = self._dispatched(name, allocations.get(name))
            except UnknownError as error:
                self.left_out[name] = str(error)
        paths = sorted({self.path(item.scheduled) for item in self.processes.values()})
        # Between two levels there is one for those that keep off everybody of the lower one.
        self._levels = {path: 2 * number + 2 for number, path in enumerate(paths)}
        for item in self.processes.values():
            if not item.scheduled.is_isr:
                for key in product(item.cores, (None, item.scheduled.group)):
                    self._highest[key] = max(self._highest.get(key, 0), self.level(item.scheduled))

    def _dispatched(self, name: str, allocation: TaskAllocation | None) -> Dispatched:
        scheduled = self.context.scheduled.get(name)
        if scheduled is not None:
            found = Dispatched(scheduled, (scheduled.core,))
        elif allocation is None:
            raise UnknownError(self.context.reasons.get(name, "it is not allocated to a scheduler"))
        else:
            found = self._on_several_cores(allocation)
        if found.scheduled.order_gap is not None:
            raise UnknownError(found.scheduled.order_gap)
        server = self.servers.get(found.scheduled.server or "")
        while server is not None:
            _check_server(server)
            server = self.servers.get(server.server or "")
        return found

    def _on_several_cores(self, allocation: TaskAllocation) -> Dispatched:
        """A task under global scheduling."""
        system = self.context.system
        scheduling = SchedulingOrder(system, self.context.notes, response_time_limits(system), self.servers)
        scheduled = scheduling.on_any_core(allocation)
        allowed = allocated_cores(system).get(allocation.task, frozenset())
        cores = tuple(name for name in system.cores if name in allowed)
        if len(cores) < 2:
            raise UnknownError(self.context.reasons[allocation.task])
        if scheduled.server is not None:
            raise UnknownError("its server is responsible for several cores")
        ticks = {self.context.demand_model.frequency(core) for core in cores}
        if len(ticks) > 1:
            raise UnknownError(f"the cores that can execute it have different clocks: {', '.join(cores)}")
        return Dispatched(scheduled, cores)

    def path(self, item: ScheduledProcess) -> Rank:
        """The ranks from the core inwards, as far as a fixed order decides."""
        server = self.servers.get(item.server or "")
        if server is None:
            return item.rank
        above = self._path_of_server(server)
        return above if self.has_server_deadline(item) else (*above, *item.rank)

    def _path_of_server(self, server: Server) -> Rank:
        outer = self.servers.get(server.server or "")
        return server.rank if outer is None else (*self._path_of_server(outer), *server.rank)

    def has_server_deadline(self, item: ScheduledProcess) -> bool:
        """Whether the deadline of its server decides about a process."""
        server = self.servers.get(item.server or "")
        return server is not None and server.equal_priority is EqualPriority.EDF

    def level(self, item: ScheduledProcess) -> int:
        """Higher levels go first; even numbers from 2 on."""
        return self._levels[self.path(item)]

    @property
    def highest_level(self) -> int:
        """The highest level of all."""
        return max(self._levels.values(), default=0)

    def running_level(self, item: Dispatched) -> int:
        """The level of a process while it runs: with it, it keeps off the tasks that cannot preempt it."""
        own = item.scheduled
        is_alone = preemption(own) is Preemption.NON_PREEMPTIVE
        if own.is_isr or (own.group is None and not is_alone):
            return self.level(own)
        return max(self._highest[core, None if is_alone else own.group] for core in item.cores) + 1

    def domains(self) -> list[tuple[str, ...]]:
        """The cores, those together that share processes."""
        group = {core: {core} for core in self.context.system.cores}
        for item in self.processes.values():
            joined = set().union(*(group[core] for core in item.cores))
            for core in joined:
                group[core] = joined
        order = list(self.context.system.cores)
        found = {min(map(order.index, cores)): cores for cores in group.values()}
        return [tuple(sorted(cores, key=order.index)) for _, cores in sorted(found.items())]


def _check_server(server: Server) -> None:
    """Refuse what the kernel does not know."""
    policy = standard_policy(server.scheduler.policy)
    is_edf = server.equal_priority is EqualPriority.EDF
    assert policy in SERVERS
    if is_edf and policy not in (Policy.CONSTANT_BANDWIDTH_SERVER, Policy.CONSTANT_BANDWIDTH_SERVER_WITH_CASH):
        raise UnknownError(f"its server {server.name!r} has a budget of the policy {policy} under earliest deadline first")
    if is_edf and server.server is not None:
        raise UnknownError(f"its server {server.name!r} has deadlines within another server")
