"""Processes, cores, domains of cores that share processes, and servers as records: how they are scheduled, and what they execute."""

from __future__ import annotations

from math import gcd

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.os import Policy, Scheduler
from amalthea_uros.perf.software import Preemption, Task
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.program.body import Body, process_code
from amalthea_uros.simulate.program.chains import ChainCompiler
from amalthea_uros.simulate.program.host_system import host_name
from amalthea_uros.simulate.program.image import Code, Image, ProgramHooks
from amalthea_uros.simulate.program.resources import Resources
from amalthea_uros.simulate.program.scheduling import Dispatched, Dispatching
from amalthea_uros.timing.blocking.critical_sections import protection_of
from amalthea_uros.timing.jobs.executed import states_execution_time
from amalthea_uros.timing.scheduling.allocation import standard_policy
from amalthea_uros.timing.scheduling.scheduled import EqualPriority, preemption
from amalthea_uros.trace.table import EntityKind, EventKind

#: Places for what a sporadic server gets back.
_PLANS = 64
_KINDS = {
    Policy.DEFERRABLE_SERVER: layout.DEFERRABLE,
    Policy.POLLING_SERVER: layout.POLLING_SERVER,
    Policy.SPORADIC_SERVER: layout.SPORADIC,
    Policy.CONSTANT_BANDWIDTH_SERVER: layout.CONSTANT_BANDWIDTH,
    Policy.CONSTANT_BANDWIDTH_SERVER_WITH_CASH: layout.CONSTANT_BANDWIDTH,
}


@dataclass(slots=True)
class HardwareRecords:
    """The records of cores, domains and servers.

    Attributes
    ----------
    cores, servers : by name
    domains : by core
    """

    resources: Resources
    dispatching: Dispatching
    cores: dict[str, int] = field(default_factory=dict)
    domains: dict[str, int] = field(default_factory=dict)
    servers: dict[str, int] = field(default_factory=dict)

    def place_cores(self) -> None:
        """Cores, and domains of those that share processes."""
        for number, core in enumerate(self.resources.context.system.cores):
            entity = self.resources.entities.number(EntityKind.CORE, core)
            fields = {layout.STOP: layout.NEVER, layout.CORE_NUMBER: number, layout.CORE_ENTITY: entity}
            self.cores[core] = self.resources.image.record(layout.CORE_SIZE, fields)
        for cores in self.dispatching.domains():
            domain = self.resources.image.record(layout.DOMAIN_SIZE)
            first, end = self.resources.image.items(self.cores[core] for core in cores)
            self.resources.image.put(domain, {layout.ITS_CORES: first, layout.ITS_CORES_END: end})
            for core in cores:
                self.domains[core] = domain
                self.resources.image.put(self.cores[core], {layout.CORE_DOMAIN: domain})

    def place_servers(self) -> None:
        """Servers that serve any of the processes that have records."""
        processes = self.resources.processes
        here = [self.dispatching.processes[name].scheduled for name in processes]
        for name in self.dispatching.servers:
            if any(self._is_within(item.server, name) for item in here):
                self.servers[name] = self.resources.image.record(layout.SERVER_SIZE)
        for name, record in self.servers.items():
            server = self.dispatching.servers[name]
            policy = standard_policy(server.scheduler.policy)
            is_host = name in map(host_name, self.resources.context.system.host.executors)
            kind = layout.THROTTLED_BANDWIDTH if is_host else _KINDS[Policy(policy or "")]
            if policy == Policy.CONSTANT_BANDWIDTH_SERVER_WITH_CASH:
                self.resources.context.notes.assume(f"the server {name!r} does not reuse what other servers leave")
            budget, period = self.resources.time(server.budget), self.resources.time(server.period)
            common = gcd(budget, period)
            served = [processes[item.name] for item in here if self._is_within(item.server, name)]
            first, end = self.resources.image.items(served)
            plans, plans_end = self.resources.image.items([0] * (_PLANS * layout.PLAN_SIZE if kind == layout.SPORADIC else 0))
            fields = {
                # The first period begins at 0: then a polling server loses its budget if it has nothing to serve.
                layout.SERVER_AT: 0 if kind in (layout.DEFERRABLE, layout.POLLING_SERVER) else layout.NEVER,
                layout.BUDGET: budget,
                layout.FULL_BUDGET: budget,
                layout.SERVER_PERIOD: period,
                layout.SERVER_KIND: kind,
                layout.PARENT: self.servers.get(server.server or "", 0),
                layout.SERVER_DOMAIN: self.domains[server.core],
                layout.SERVED: first,
                layout.SERVED_END: end,
                layout.BUDGET_RATIO: budget // common,
                layout.PERIOD_RATIO: period // common,
                layout.PLANS: plans,
                layout.PLANS_END: plans_end,
            }
            self.resources.image.put(record, fields)

    def _is_within(self, server: str | None, outer: str) -> bool:
        while server is not None and server != outer:
            server = self.dispatching.servers[server].server
        return server == outer


# Processes, and decisions of schedulers.


#: Places for activations of each process to begin with.
PLACES_AT_FIRST = 4


@dataclass(slots=True)
class ProcessRecords:
    """The records of processes, and of decisions of schedulers.

    Attributes
    ----------
    decisions : by scheduler and core
    """

    resources: Resources
    hardware: HardwareRecords
    chains: ChainCompiler
    decisions: dict[tuple[str, str], int] = field(default_factory=dict)

    @property
    def image(self) -> Image:
        """The memory."""
        return self.resources.image

    def add(self, item: Dispatched, number: int) -> None:
        """Fill the record of a process, which has a number in rows.

        Raises
        ------
        UnknownError : something in it cannot be simulated.
        """
        scheduled, context, chains = item.scheduled, self.resources.context, self.chains
        process = scheduled.process
        if not states_execution_time(process, context.system):
            raise UnknownError("it has no execution time, and neither have the runnables that it calls")
        core = item.cores[0]
        scheduler = context.deciding(item.name, core)
        hooks = chains.hooks.get(item.name, ProgramHooks())
        code = process_code(self.resources, process, core, hooks, scheduler, in_group=scheduled.group is not None)
        captures, captures_end = self.image.items(chains.captures.get(item.name, ()))
        lets, lets_end = self.image.items(chains.let_stages.get(item.name, ()))
        semaphores, events = len(self.resources.semaphores), len(self.resources.os_events)
        queue, _ = self.image.items([0] * (PLACES_AT_FIRST * (layout.QUEUE_CAPTURES + captures_end - captures)))
        transitions = self.resources.watches.transitions(item.name)
        allowed, _ = self.image.items(int(name in item.cores) for name in self.hardware.cores)
        is_edf = scheduled.equal_priority is EqualPriority.EDF
        has_server_deadline = self.hardware.dispatching.has_server_deadline(scheduled)
        level = self.hardware.dispatching.level(scheduled)
        is_loop = item.name in context.system.executor_of_task
        fields = {
            layout.LEVEL: level,
            layout.OWN_LEVEL: level,
            layout.RUNNING_LEVEL: self.hardware.dispatching.running_level(item),
            layout.INNER: _inner(item) if has_server_deadline else 0,
            layout.LIMIT: process.activation_limit if isinstance(process, Task) and not is_loop else layout.NEVER,
            layout.QUEUE: queue,
            layout.FIRST_PLACE: queue,
            layout.ENTRY: code.write(self.image),
            layout.NUMBER: number,
            layout.IS_REPORTED: 1,
            layout.ENTITY: self.resources.entities.process(item.name),
            layout.DOMAIN: self.hardware.domains[core],
            layout.ALLOWED: allowed,
            layout.IS_COOPERATIVE: int(not scheduled.is_isr and preemption(scheduled) is Preemption.COOPERATIVE),
            layout.IS_BY_DEADLINE: int(is_edf),
            layout.HAS_SERVER_DEADLINE: int(has_server_deadline),
            layout.RELATIVE_DEADLINE: self.resources.time(scheduled.deadline or 0) if is_edf else 0,
            layout.SLICE: self.resources.time(scheduled.slice),
            layout.SERVER: self.hardware.servers.get(scheduled.server or "", 0),
            layout.DECISION: self._decision(scheduler, core) if scheduler is not None else 0,
            layout.CAPTURES: captures,
            layout.CAPTURES_END: captures_end,
            layout.LET_STAGES: lets,
            layout.LET_STAGES_END: lets_end,
            layout.HOLDS: self.image.items([0] * (semaphores * layout.HOLD_SIZE))[0],
            layout.EVENTS_SET: self.image.items([0] * events)[0],
            layout.TICKETS: self.image.items([0] * len(self.resources.services))[0],
            layout.WATCHED: self.image.items(transitions)[0] if transitions else 0,
            layout.IS_ABOUT_MESSAGE: int(self.resources.executors.messages.is_about_message(item.name)),
        }
        self.image.put(self.resources.processes[item.name], fields)

    def _decision(self, scheduler: Scheduler, core: str) -> int:
        """What decides for a scheduler on a core when a task is activated: it precedes everything else."""
        key = (scheduler.name, core)
        if key not in self.decisions:
            level = self.hardware.dispatching.highest_level + 2
            queue, _ = self.image.items([0] * (PLACES_AT_FIRST * layout.QUEUE_CAPTURES))
            allowed, _ = self.image.items(int(name == core) for name in self.hardware.cores)
            fields = {
                layout.LEVEL: level,
                layout.OWN_LEVEL: level,
                layout.RUNNING_LEVEL: level,
                layout.LIMIT: layout.NEVER,
                layout.QUEUE: queue,
                layout.FIRST_PLACE: queue,
                layout.ENTRY: decision_code(self.resources, scheduler, core).write(self.image),
                layout.ENTITY: self.resources.entities.number(EntityKind.SCHEDULER, scheduler.name),
                layout.DOMAIN: self.hardware.domains[core],
                layout.ALLOWED: allowed,
                layout.HOLDS: self.image.items([0] * (len(self.resources.semaphores) * layout.HOLD_SIZE))[0],
            }
            self.decisions[key] = self.image.record(layout.PROCESS_SIZE, fields)
        return self.decisions[key]

    def place_members(self) -> None:
        """The members of each domain, highest level first; those of a level in the order of the model."""
        words = self.image.words
        everything = [*self.resources.processes.values(), *self.decisions.values()]
        for domain in set(self.hardware.domains.values()):
            members = [record for record in everything if words[record + layout.DOMAIN] == domain]
            members.sort(key=lambda record: -words[record + layout.OWN_LEVEL])
            first, end = self.image.items(members)
            groups, _ = self.image.items(0 for _ in members[:: layout.GROUP_OF_MEMBERS])
            for number, record in enumerate(members):
                self.image.put(record, {layout.GROUP: groups + number // layout.GROUP_OF_MEMBERS})
            fields = {
                layout.MEMBERS: first,
                layout.MEMBERS_END: end,
                layout.GROUPS: groups,
                layout.HAS_COOPERATIVE: int(any(words[record + layout.IS_COOPERATIVE] for record in members)),
            }
            self.image.put(domain, fields)

    def place_ceilings(self) -> None:
        """The ceilings of semaphores: of all that use them."""
        words, system = self.image.words, self.resources.context.system
        uses = {name: protection_of(system.processes[name], system) for name in self.resources.processes}
        for semaphore in system.os.semaphores:
            if not semaphore.ceiling:
                continue
            users = [self.resources.processes[name] for name in uses if semaphore.name in uses[name].semaphores]
            deadlines = [words[user + layout.RELATIVE_DEADLINE] for user in users if words[user + layout.IS_BY_DEADLINE]]
            fields = {
                layout.CEILING: max((words[user + layout.OWN_LEVEL] for user in users), default=0) + 1,
                layout.DEADLINE_CEILING: min(deadlines, default=layout.NEVER),
            }
            self.image.put(self.resources.semaphores[semaphore.name], fields)


def _inner(item: Dispatched) -> int:
    """The order within a server that has a deadline itself."""
    return item.scheduled.rank[-1] if item.scheduled.rank else 0


def decision_code(resources: Resources, scheduler: Scheduler, core: str) -> Code:
    """The program of a decision of a scheduler; raises as `body.process_code`."""
    body = Body(resources, None, core, ProgramHooks(), in_group=False)
    body.activities(scheduler.overhead)
    if resources.is_noted:
        body.code.add(layout.NOTE, int(EventKind.SCHEDULE), resources.entities.number(EntityKind.SCHEDULER, scheduler.name))
    body.code.add(layout.END)
    return body.code
