"""Everything together: a system as the memory of the kernel, its streams, and the stimuli that come from outside."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import gcd, lcm

from amalthea_uros.perf.activities import Trigger
from amalthea_uros.perf.events import StimulusEvent
from amalthea_uros.perf.os import Policy, Scheduler
from amalthea_uros.perf.software import Preemption, Task
from amalthea_uros.perf.stimuli import EventTriggered, InterProcess, Stimulus
from amalthea_uros.simulate.arrivals import Occurrences, UnknownArrivalError, occurrences
from amalthea_uros.simulate.layout import (
    ALLOWED,
    ASSIGNMENTS,
    ASSIGNMENTS_END,
    BUDGET,
    BUDGET_RATIO,
    CAPTURES,
    CAPTURES_END,
    CEILING,
    CONDITION,
    CONSTANT_BANDWIDTH,
    CORE_DOMAIN,
    CORE_ENTITY,
    CORE_NUMBER,
    CORE_SIZE,
    CORES,
    CORES_END,
    COUNTER,
    DEADLINE_CEILING,
    DECISION,
    DEFERRABLE,
    DOMAIN,
    DOMAIN_SIZE,
    DOMAINS,
    DOMAINS_END,
    ENTITY,
    ENTRY,
    EVENTS_SET,
    FIRST_PLACE,
    FULL_BUDGET,
    HAS_COOPERATIVE,
    HAS_SERVER_DEADLINE,
    HAS_WRITES,
    HOLD_SIZE,
    HOLDS,
    INNER,
    IS_BY_DEADLINE,
    IS_COOPERATIVE,
    IS_REPORTED,
    ITS_CORES,
    ITS_CORES_END,
    LET_STAGES,
    LET_STAGES_END,
    LEVEL,
    LIMIT,
    MEMBERS,
    MEMBERS_END,
    NEVER,
    NUMBER,
    OWN_LEVEL,
    PARENT,
    PERIOD_RATIO,
    PLACES,
    PLAN_SIZE,
    PLANS,
    PLANS_END,
    POLLING_SERVER,
    PROCESS_SIZE,
    PROCESSES,
    PROCESSES_END,
    QUEUE,
    QUEUE_CAPTURES,
    RELATIVE_DEADLINE,
    RUNNING_LEVEL,
    SEMAPHORES,
    SEMAPHORES_END,
    SERVED,
    SERVED_END,
    SERVER,
    SERVER_AT,
    SERVER_DOMAIN,
    SERVER_KIND,
    SERVER_PERIOD,
    SERVER_SIZE,
    SERVERS,
    SERVERS_END,
    SLICE,
    SPORADIC,
    STIMULUS_ENTITY,
    STIMULUS_SIZE,
    STIMULUS_SOURCE,
    STOP,
    TARGETS,
    TARGETS_END,
    TICKETS,
    WATCHED,
)
from amalthea_uros.simulate.operations import FIRE, PUT
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.program.body import BodyCompiler, Hooks
from amalthea_uros.simulate.program.chains import ChainCompiler, FollowedRoute
from amalthea_uros.simulate.program.entities import Entities
from amalthea_uros.simulate.program.image import Image
from amalthea_uros.simulate.program.messages import Messages
from amalthea_uros.simulate.program.modes import Modes
from amalthea_uros.simulate.program.obstacles import NotSimulatedError
from amalthea_uros.simulate.program.resources import Resources
from amalthea_uros.simulate.program.scheduling import Dispatched, Dispatching
from amalthea_uros.simulate.program.watches import Source, Watches, watched
from amalthea_uros.simulate.sampling.random_source import RandomSource
from amalthea_uros.simulate.sampling.streams import Stream
from amalthea_uros.timing.activation import UnknownActivationError
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.critical_sections import protection_of
from amalthea_uros.timing.preemption import preemption
from amalthea_uros.timing.scheduling import EqualPriority, standard_policy
from amalthea_uros.timing.stated_demand import states_execution_time
from amalthea_uros.trace.table import Entity, EntityKind
from amalthea_uros.units import Time

#: Sums of times must fit into 63 bits: the longest time of a run, in time units.
_LONGEST = 2**60
#: Places for activations of each process to begin with, and for what a sporadic server gets back.
_PLACES, _PLANS = 4, 64

_KINDS = {
    Policy.DEFERRABLE_SERVER: DEFERRABLE,
    Policy.POLLING_SERVER: POLLING_SERVER,
    Policy.SPORADIC_SERVER: SPORADIC,
    Policy.CONSTANT_BANDWIDTH_SERVER: CONSTANT_BANDWIDTH,
    Policy.CONSTANT_BANDWIDTH_SERVER_WITH_CASH: CONSTANT_BANDWIDTH,
}


@dataclass(frozen=True, slots=True)
class Program:
    """A system as the kernel plays it.

    Attributes
    ----------
    memory : of the kernel, at time 0
    units : time units per picosecond
    streams, stream_records : what is drawn from, and the records by which programs know it
    arrivals : of each stimulus that comes from outside: its record, and when it occurs
    processes : the names of the processes in the order of their numbers in rows
    records, cores, channels : the records of processes, cores and channels, by name
    messages : the queues of messages with arrivals of their own, by process and source
    queues : the records of everything that is activated
    sources : of events that are watched, in the order of their numbers in rows
    runnables : that are measured, in the order of their numbers in rows, which follow those of the processes
    left_out : why a process is not simulated
    chains_left_out : why a chain is not followed
    """

    memory: list[int]
    units: int
    streams: Sequence[Stream]
    stream_records: Sequence[int]
    arrivals: Sequence[tuple[int, Occurrences]]
    processes: tuple[str, ...]
    records: dict[str, int]
    cores: dict[str, int]
    channels: dict[str, int]
    messages: dict[tuple[str, str], int]
    queues: tuple[int, ...]
    entities: tuple[Entity, ...]
    routes: tuple[FollowedRoute, ...]
    sources: tuple[Source, ...]
    runnables: tuple[str, ...]
    left_out: dict[str, str]
    chains_left_out: dict[str, str]


def build_program(context: TimingContext, options: Options) -> Program:
    """The program of a system; what cannot be simulated is left out of it, and said so there."""
    builder = _Builder(context, options)
    # A process that cannot be simulated changes what others, its chains and triggers do: begin again without it.
    while (found := builder.build()) is None:
        builder = _Builder(context, options, builder.left_out)
    return found


@dataclass(slots=True)
class _Builder:
    context: TimingContext
    options: Options
    left_out: dict[str, str] = field(default_factory=dict)
    image: Image = field(default_factory=Image)
    dispatching: Dispatching = field(init=False)
    entities: Entities = field(init=False)
    resources: Resources = field(init=False)
    modes: Modes = field(init=False)
    processes: dict[str, int] = field(default_factory=dict)
    stimuli: dict[str, int] = field(default_factory=dict)
    servers: dict[str, int] = field(default_factory=dict)
    cores: dict[str, int] = field(default_factory=dict)
    domains: dict[str, int] = field(default_factory=dict)
    decisions: dict[tuple[str, str], int] = field(default_factory=dict)
    watches: Watches = field(init=False)

    def __post_init__(self) -> None:
        self.entities = Entities(self.context.system)
        self.dispatching = Dispatching(self.context)
        self.left_out = self.dispatching.left_out | self.left_out
        self.resources = Resources(self.context, self.options, self.image, self.entities, self._units())
        self.watches = Watches(watched(self.context.system, self.options.watched_labels(self.context.system)))
        self.modes = Modes(self.context.system, self.image, self.context.settings.modes)

    def _units(self) -> int:
        """Time units per picosecond, so that each tick is a whole number of them, if such times are not too long."""
        system, model = self.context.system, self.context.demand_model
        found = lcm(*(model.time_base(core) for core in system.cores))
        if found * self.options.duration <= _LONGEST:
            return found
        self.context.notes.assume("execution times are rounded to picoseconds")
        return 1

    def build(self) -> Program | None:
        """The program; None if one more process has turned out to be impossible."""
        system = self.context.system
        here = {name: item for name, item in self.dispatching.processes.items() if name not in self.left_out}
        for name in here:
            self.processes[name] = self.image.record(PROCESS_SIZE)
        for name in system.stimuli_by_name:
            self.stimuli[name] = self.image.record(STIMULUS_SIZE)
        runnables = self.watches.watched.runnables
        self.watches.measured = {name: len(here) + number for number, name in enumerate(runnables)}
        chains = ChainCompiler(self.resources, self.processes)
        for chain in system.events.chains:
            chains.add(chain)
        before = len(self.left_out)
        self._hook_firings(chains, here)
        self._place_cores(here)
        self._place_servers(here)
        is_noted = self.options.traced is not None
        messages = Messages(self.resources, chains)
        bodies = BodyCompiler(self.resources, self.modes, self.processes, self.stimuli, messages.queues, is_noted, self.watches)
        for number, item in enumerate(here.values()):
            try:
                messages.add(item.scheduled.process)
                self._process(item, number, bodies, chains)
            except NotSimulatedError as error:
                self.left_out[item.name] = str(error)
        arrivals = self._place_stimuli(here)
        if len(self.left_out) > before:
            return None
        self._place_domains(here)
        self._place_ceilings(here)
        self._head(chains)
        return Program(
            memory=self.image.words,
            units=self.resources.units,
            streams=self.resources.streams,
            stream_records=self.resources.stream_records,
            # What arrives at the time of an activation is there before it.
            arrivals=[*messages.arrivals, *arrivals],
            messages=messages.queues,
            processes=tuple(here),
            records=self.processes,
            cores=self.cores,
            channels=self.modes.channels,
            queues=(*self.processes.values(), *self.decisions.values()),
            entities=self.entities.all,
            routes=tuple(chains.routes),
            sources=tuple(self.watches.sources),
            runnables=runnables,
            left_out=self.left_out,
            chains_left_out=chains.left_out,
        )

    def _set(self, record: int, fields: dict[int, int]) -> None:
        for number, value in fields.items():
            self.image.words[record + number] = value

    def _time(self, time: Time) -> int:
        return min(time * self.resources.units, NEVER)

    # Hardware and servers.

    def _place_cores(self, here: dict[str, Dispatched]) -> None:
        for number, core in enumerate(self.context.system.cores):
            entity = self.entities.number(EntityKind.CORE, core)
            fields = {STOP: NEVER, CORE_NUMBER: number, CORE_ENTITY: entity}
            self.cores[core] = self.image.record(CORE_SIZE, fields)
        self.dispatching.processes = here
        for cores in self.dispatching.domains():
            domain = self.image.record(DOMAIN_SIZE)
            first, end = self.image.items(self.cores[core] for core in cores)
            self._set(domain, {ITS_CORES: first, ITS_CORES_END: end})
            for core in cores:
                self.domains[core] = domain
                self._set(self.cores[core], {CORE_DOMAIN: domain})

    def _place_servers(self, here: dict[str, Dispatched]) -> None:
        for name in self.dispatching.servers:
            if any(self._is_within(item.scheduled.server, name) for item in here.values()):
                self.servers[name] = self.image.record(SERVER_SIZE)
        for name, record in self.servers.items():
            server = self.dispatching.servers[name]
            policy = standard_policy(server.scheduler.policy)
            kind = _KINDS[Policy(policy or "")]
            if policy == Policy.CONSTANT_BANDWIDTH_SERVER_WITH_CASH:
                self.context.notes.assume(f"the server {name!r} does not reuse what other servers leave")
            budget, period = self._time(server.budget), self._time(server.period)
            common = gcd(budget, period)
            served = [self.processes[item.name] for item in here.values() if self._is_within(item.scheduled.server, name)]
            first, end = self.image.items(served)
            plans, plans_end = self.image.items([0] * (_PLANS * PLAN_SIZE if kind == SPORADIC else 0))
            fields = {
                # The first period begins at 0: then a polling server loses its budget if it has nothing to serve.
                SERVER_AT: 0 if kind in (DEFERRABLE, POLLING_SERVER) else NEVER,
                BUDGET: budget,
                FULL_BUDGET: budget,
                SERVER_PERIOD: period,
                SERVER_KIND: kind,
                PARENT: self.servers.get(server.server or "", 0),
                SERVER_DOMAIN: self.domains[server.core],
                SERVED: first,
                SERVED_END: end,
                BUDGET_RATIO: budget // common,
                PERIOD_RATIO: period // common,
                PLANS: plans,
                PLANS_END: plans_end,
            }
            self._set(record, fields)

    def _is_within(self, server: str | None, outer: str) -> bool:
        while server is not None and server != outer:
            server = self.dispatching.servers[server].server
        return server == outer

    # Processes.

    def _process(self, item: Dispatched, number: int, bodies: BodyCompiler, chains: ChainCompiler) -> None:
        scheduled, record, context = item.scheduled, self.processes[item.name], self.context
        process = scheduled.process
        if not states_execution_time(process, context.system):
            raise NotSimulatedError("it has no execution time, and neither have the runnables that it calls")
        core = item.cores[0]
        scheduler = context.deciding(item.name, core)
        in_group = scheduled.group is not None
        code = bodies.process(process, core, chains.hooks.get(item.name, Hooks()), scheduler, in_group)
        captures, captures_end = self.image.items(chains.captures.get(item.name, ()))
        lets, lets_end = self.image.items(chains.let_stages.get(item.name, ()))
        semaphores, events = len(self.resources.semaphores), len(self.resources.os_events)
        queue, _ = self.image.items([0] * (_PLACES * (QUEUE_CAPTURES + captures_end - captures)))
        transitions = self.watches.transitions(item.name)
        allowed, _ = self.image.items(int(name in item.cores) for name in self.cores)
        is_edf = scheduled.equal_priority is EqualPriority.EDF
        has_server_deadline = self.dispatching.has_server_deadline(scheduled)
        level = self.dispatching.level(scheduled)
        fields = {
            LEVEL: level,
            OWN_LEVEL: level,
            RUNNING_LEVEL: self.dispatching.running_level(item),
            INNER: self._inner(item) if has_server_deadline else 0,
            LIMIT: process.activation_limit if isinstance(process, Task) else NEVER,
            QUEUE: queue,
            FIRST_PLACE: queue,
            ENTRY: code.write(self.image),
            NUMBER: number,
            IS_REPORTED: 1,
            ENTITY: self.entities.process(item.name),
            DOMAIN: self.domains[core],
            ALLOWED: allowed,
            IS_COOPERATIVE: int(not scheduled.is_isr and preemption(scheduled) is Preemption.COOPERATIVE),
            IS_BY_DEADLINE: int(is_edf),
            HAS_SERVER_DEADLINE: int(has_server_deadline),
            RELATIVE_DEADLINE: self._time(scheduled.deadline or 0) if is_edf else 0,
            SLICE: self._time(scheduled.slice) if scheduled.equal_priority is EqualPriority.ROUND_ROBIN else 0,
            SERVER: self.servers.get(scheduled.server or "", 0),
            DECISION: self._decision(scheduler, core, bodies) if scheduler is not None else 0,
            CAPTURES: captures,
            CAPTURES_END: captures_end,
            LET_STAGES: lets,
            LET_STAGES_END: lets_end,
            HOLDS: self.image.items([0] * (semaphores * HOLD_SIZE))[0],
            EVENTS_SET: self.image.items([0] * events)[0],
            TICKETS: self.image.items([0] * len(self.resources.services))[0],
            WATCHED: self.image.items(transitions)[0] if transitions else 0,
        }
        self._set(record, fields)

    def _inner(self, item: Dispatched) -> int:
        """The order within a server that has a deadline itself."""
        return item.scheduled.rank[-1] if item.scheduled.rank else 0

    def _decision(self, scheduler: Scheduler, core: str, bodies: BodyCompiler) -> int:
        """What decides for a scheduler on a core when a task is activated: it precedes everything else."""
        key = (scheduler.name, core)
        if key not in self.decisions:
            level = self.dispatching.highest_level + 2
            queue, _ = self.image.items([0] * (_PLACES * QUEUE_CAPTURES))
            allowed, _ = self.image.items(int(name == core) for name in self.cores)
            fields = {
                LEVEL: level,
                OWN_LEVEL: level,
                RUNNING_LEVEL: level,
                LIMIT: NEVER,
                QUEUE: queue,
                FIRST_PLACE: queue,
                ENTRY: bodies.decision(scheduler, core).write(self.image),
                ENTITY: self.entities.number(EntityKind.SCHEDULER, scheduler.name),
                DOMAIN: self.domains[core],
                ALLOWED: allowed,
                HOLDS: self.image.items([0] * (len(self.resources.semaphores) * HOLD_SIZE))[0],
            }
            self.decisions[key] = self.image.record(PROCESS_SIZE, fields)
        return self.decisions[key]

    def _place_domains(self, here: dict[str, Dispatched]) -> None:
        """The members of each domain, highest level first; those of a level in the order of the model."""
        words = self.image.words
        everything = [*self.processes.values(), *self.decisions.values()]
        for domain in set(self.domains.values()):
            members = [record for record in everything if words[record + DOMAIN] == domain]
            members.sort(key=lambda record: -words[record + OWN_LEVEL])
            first, end = self.image.items(members)
            fields = {
                MEMBERS: first,
                MEMBERS_END: end,
                HAS_COOPERATIVE: int(any(words[record + IS_COOPERATIVE] for record in members)),
            }
            self._set(domain, fields)

    def _place_ceilings(self, here: dict[str, Dispatched]) -> None:
        words, system = self.image.words, self.context.system
        uses = {name: protection_of(system.processes[name], system) for name in here}
        for semaphore in system.os.semaphores:
            if not semaphore.ceiling:
                continue
            users = [self.processes[name] for name in here if semaphore.name in uses[name].semaphores]
            deadlines = [words[user + RELATIVE_DEADLINE] for user in users if words[user + IS_BY_DEADLINE]]
            fields = {
                CEILING: max((words[user + OWN_LEVEL] for user in users), default=0) + 1,
                DEADLINE_CEILING: min(deadlines, default=NEVER),
            }
            self._set(self.resources.semaphores[semaphore.name], fields)

    # Stimuli.

    def _hook_firings(self, chains: ChainCompiler, here: dict[str, Dispatched]) -> None:
        """Stimuli that events fire; triggers fire theirs by themselves."""
        if not any(isinstance(stimulus, EventTriggered) for stimulus in self.context.system.stimuli.stimuli):
            return
        for name in here:
            hooks = chains.hooks.setdefault(name, Hooks())
            for firing in self.context.dataflow.firings(name):
                if not isinstance(firing.position.activity, Trigger):
                    side = hooks.before if firing.is_before else hooks.after
                    side.setdefault(firing.position.number, []).append((FIRE, self.stimuli[firing.stimulus], 0))

    def _place_stimuli(self, here: dict[str, Dispatched]) -> list[tuple[int, Occurrences]]:
        """The stimuli, and the occurrences of those that come from outside."""
        system = self.context.system
        activated: dict[str, list[str]] = {}
        for name, item in here.items():
            for stimulus_name in item.scheduled.process.stimuli:
                activated.setdefault(stimulus_name, []).append(name)
        order = {name: number for number, name in enumerate(here)}
        external: list[tuple[int, int, Occurrences]] = []
        for name, record in self.stimuli.items():
            stimulus, targets = system.stimuli_by_name[name], activated.get(name, [])
            try:
                self._stimulus(stimulus, record, targets)
                if isinstance(stimulus, EventTriggered) and not self.context.activations.causes(stimulus):
                    raise NotSimulatedError(f"no activity in the model raises an event of the stimulus {name!r}")
                is_internal = isinstance(stimulus, InterProcess | EventTriggered)
                is_watched = self.image.words[record + STIMULUS_SOURCE] > 0
                if not is_internal and (targets or stimulus.assignments or is_watched):
                    first = min((order[target] for target in targets), default=len(order))
                    external.append((first, record, self._occurrences(stimulus)))
            except (NotSimulatedError, UnknownArrivalError, UnknownActivationError) as error:
                for target in targets:
                    self.left_out[target] = str(error)
        # Of simultaneous activations, that of the process comes first that is the first one of the model.
        external.sort(key=lambda entry: entry[0])
        return [(record, found) for _, record, found in external]

    def _occurrences(self, stimulus: Stimulus) -> Occurrences:
        source = RandomSource(self.options.seed, f"stimulus {stimulus.name}")
        found = occurrences(stimulus, self.context.system, self.options.mode, source, self.resources.units)
        for sentence in found.assumptions:
            self.context.notes.assume(sentence)
        return found

    def _stimulus(self, stimulus: Stimulus, record: int, targets: Sequence[str]) -> None:
        first, end = self.image.items(self.processes[target] for target in targets)
        pairs: list[int] = []
        for assignment in stimulus.assignments:
            pairs += (self.modes.label(assignment.label), self.modes.value(assignment.label, assignment.value))
        assignments, assignments_end = self.image.items(pairs)
        counter = stimulus.counter if isinstance(stimulus, InterProcess | EventTriggered) else None
        source = self.watches.number(Source(StimulusEvent, stimulus.name))
        fields = {
            TARGETS: first,
            TARGETS_END: end,
            CONDITION: self.modes.condition(stimulus.condition) if stimulus.condition is not None else 0,
            COUNTER: self.resources.counter(stimulus, counter),
            ASSIGNMENTS: assignments,
            ASSIGNMENTS_END: assignments_end,
            STIMULUS_ENTITY: self.entities.number(EntityKind.STIMULUS, stimulus.name),
            STIMULUS_SOURCE: 0 if source is None else source + 1,
        }
        self._set(record, fields)

    def _head(self, chains: ChainCompiler) -> None:
        lists = {
            (CORES, CORES_END): self.cores.values(),
            (DOMAINS, DOMAINS_END): dict.fromkeys(self.domains.values()),
            (SERVERS, SERVERS_END): self.servers.values(),
            (PROCESSES, PROCESSES_END): self.processes.values(),
            (SEMAPHORES, SEMAPHORES_END): self.resources.semaphores.values(),
        }
        for (first, end), records in lists.items():
            places = self.image.items(records)
            self._set(0, dict(zip((first, end), places, strict=True)))
        has_writes = len(self.cores) > 1 and any(
            operation == PUT for hooks in chains.hooks.values() for operation, *_ in hooks.all()
        )
        self._set(0, {PLACES: _PLACES, HAS_WRITES: int(has_writes)})
