"""The timing context of a system: scheduling, demand and activation of its processes, and why something is unknown."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from functools import cached_property
from typing import TypeVar

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.os import Policy, Scheduler
from amalthea_uros.perf.stimuli import EventTriggered, InterProcess
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.activations import Activations, TriggeredTogether, triggered_together
from amalthea_uros.timing.activation.releases import arrival_assumptions, response_time_limits, with_bounded_arrivals
from amalthea_uros.timing.basics.notes import AnalysisNotes
from amalthea_uros.timing.basics.settings import MemoryModel, Settings
from amalthea_uros.timing.basics.time_base import MAX_INPUT
from amalthea_uros.timing.blocking.critical_sections import Locks, LockUsage, spinlocks_of
from amalthea_uros.timing.blocking.regions import ProcessRegions, RegionKind, RegionWalk
from amalthea_uros.timing.dataflow.links import Dataflow
from amalthea_uros.timing.demand.model import DemandModel
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.demand.overheads import ASSUMPTION as OVERHEAD_ASSUMPTION
from amalthea_uros.timing.demand.overheads import has_overhead_of_tasks
from amalthea_uros.timing.demand.quantiles import quantile_assumption, with_quantiles
from amalthea_uros.timing.event_models.models import EventModel
from amalthea_uros.timing.jobs.executed import states_execution_time, with_direct_calls
from amalthea_uros.timing.scheduling.allocation import allocated_cores, effective_priority
from amalthea_uros.timing.scheduling.ranks import SchedulingOrder
from amalthea_uros.timing.scheduling.scheduled import ScheduledProcess, Server
from amalthea_uros.timing.touching import Touching, why_suspended, with_successors
from amalthea_uros.timing.waits import WITHOUT_BOUND, WaitingProcess, awaited_events

T = TypeVar("T")

#: Servers that go on with a later deadline when their budget is used up (Abeni and Buttazzo 1998).
LENDING_SERVERS = (Policy.CONSTANT_BANDWIDTH_SERVER, Policy.CONSTANT_BANDWIDTH_SERVER_WITH_CASH)


@dataclass(frozen=True, slots=True)
class ProcessPlacement:
    """The core and the priority of a process; None if it has none or several."""

    core: str | None = None
    priority: int | None = None


@dataclass
class TimingContext:
    """A system as analyses, simulation and rules see it; mappings are by the names of processes.

    Attributes
    ----------
    scheduled : core, server and rank of each process
    demands : execution demand, in the time base of the core, including scheduler decisions at the end of jobs
    decisions : demand of scheduler decisions at activations, if the model specifies it
    reasons : why the response time of a process is unknown
    waiting : processes whose waits for events depend on response times; `demands` has those of which the solution knows a bound
    unclear_locks : why the critical sections of a process are unknown
    unknown_demands : why the execution demand of a process does not follow from its activities
    alike : of a system whose processes differ only in the offsets of counters; what does not depend on these is taken from it
    open_semaphores : those without a ceiling, or held while waiting for one without: others than the holder delay who waits
    """

    system: System
    settings: Settings = field(default_factory=Settings)
    notes: AnalysisNotes = field(default_factory=AnalysisNotes)
    scheduled: dict[str, ScheduledProcess] = field(default_factory=dict)
    servers: dict[str, Server] = field(default_factory=dict)
    demands: dict[str, MultiframeDemand] = field(default_factory=dict)
    decisions: dict[str, MultiframeDemand] = field(default_factory=dict)
    reasons: dict[str, str] = field(default_factory=dict)
    unclear_locks: dict[str, str] = field(default_factory=dict)
    waiting: dict[str, WaitingProcess] = field(default_factory=dict)
    unknown_demands: Mapping[str, str] = field(default_factory=dict)
    alike: TimingContext | None = None
    open_semaphores: frozenset[str] = frozenset()

    @classmethod
    def of(
        cls,
        system: System,
        settings: Settings | None = None,
        *,
        unknown_demands: Mapping[str, str] | None = None,
        alike: TimingContext | None = None,
    ) -> TimingContext:
        """The timing context of a system.

        Parameters
        ----------
        unknown_demands : why the jobs of processes do not only execute what their activities say
        alike : the context of a system whose processes differ only in the offsets of counters, with the same settings
        """
        context = cls.of_scheduling(with_bounded_arrivals(system), settings, alike)
        context.unknown_demands = unknown_demands or {}
        for sentence in arrival_assumptions(system):
            context.notes.assume(sentence)
        context._find_demands()
        context._find_locks()
        return context

    @classmethod
    def of_scheduling(
        cls, system: System, settings: Settings | None = None, alike: TimingContext | None = None
    ) -> TimingContext:
        """The same without demands and critical sections, for what follows the activities one by one."""
        settings = settings or Settings()
        if settings.quantile is not None:
            system = with_quantiles(system, settings.quantile)
        context = cls(with_direct_calls(system), settings, alike=alike)
        if context.system is not system:
            context.notes.assume("clients execute the runnables of synchronous servers that no process calls")
        if has_overhead_of_tasks(system):
            context.notes.assume(OVERHEAD_ASSUMPTION)
        for sentence in system.network.assumptions:
            context.notes.assume(sentence)
        context._note_settings()
        context._schedule()
        return context

    @cached_property
    def demand_model(self) -> DemandModel:
        """Converts activities to execution demand."""
        model = DemandModel(self.system, self.notes, self.settings)
        # The calls of the system are looked up once.
        model.sites = self.dataflow.events.sites
        if self.alike is not None:
            model.keep(self.alike.demand_model)
        return model

    @cached_property
    def stretches(self) -> ProcessRegions:
        """The stretches of jobs in which others cannot preempt them."""
        return ProcessRegions(self.demand_model)

    @cached_property
    def dataflow(self) -> Dataflow:
        """The positions of activities, and the links between processes."""
        alike = self.alike
        return (
            Dataflow(self.system, self.settings.communication) if alike is None else alike.dataflow.with_counters(self.system)
        )

    @cached_property
    def activations(self) -> Activations:
        """The activations of processes."""
        return Activations(self.system, self.dataflow)

    @cached_property
    def triggered_together(self) -> Sequence[TriggeredTogether]:
        """Processes of which each job of another process triggers some, each once at most."""
        return triggered_together(self.activations)

    @cached_property
    def touching(self) -> Touching:
        """What processes can touch if something about them is unknown."""
        return Touching(self.system, self.scheduled, self.dataflow) if self.alike is None else self.alike.touching

    def time_base(self, process: str) -> int:
        """Time units per picosecond on the core of a process."""
        return self.demand_model.time_base(self.scheduled[process].core)

    def placement(self, process: str) -> ProcessPlacement:
        """Where a process runs and with which priority, as far as it is known."""
        scheduled = self.scheduled.get(process)
        if scheduled is not None:
            return ProcessPlacement(scheduled.core, scheduled.priority)
        return self._placements.get(process, ProcessPlacement())

    @cached_property
    def _placements(self) -> Mapping[str, ProcessPlacement]:
        """The same for all processes, also for those whose scheduling cannot be analysed."""
        cores, mapping = allocated_cores(self.system), self.system.mapping
        priorities: dict[str, set[int | None]] = {}
        for task in mapping.tasks:
            priorities.setdefault(task.task, set()).add(effective_priority(task, self.system))
        for isr in mapping.isrs:
            priorities.setdefault(isr.isr, set()).add(isr.priority)
        return {name: ProcessPlacement(_only(cores.get(name, ())), _only(found)) for name, found in priorities.items()}

    def stated_demand(self, process: str) -> MultiframeDemand | None:
        """The demand of a process on its core, also if its scheduling cannot be analysed; None if it is unknown."""
        core, model = self.placement(process).core, self.system.processes[process]
        if process in self.waiting:
            return self.waiting[process].demand if process in self.demands else None
        if process in self.demands or core is None or not states_execution_time(model, self.system):
            return self.demands.get(process)
        try:
            return self.demand_model.of_process(model, core)
        except UnknownError:
            return None

    def stated_activations(self, process: str) -> EventModel | None:
        """The activations of a process, if they do not depend on response times; None otherwise."""
        model = self.system.processes[process]
        stimuli = [self.system.stimuli_by_name.get(name) for name in model.stimuli]
        if any(isinstance(stimulus, InterProcess | EventTriggered) for stimulus in stimuli):
            return None
        return self.activations_at_once(process)

    def activations_at_once(self, process: str) -> EventModel | None:
        """The activations of a process if no job took any time, of which the rate is right; None if they are unknown."""
        try:
            return self.activations.of(self.system.processes[process])
        except UnknownError:
            return None

    def can_borrow(self, process: str) -> bool:
        """Whether a process can execute more than the budget of its server, so that no overload of the server is certain."""
        scheduled = self.scheduled.get(process)
        server = self.servers.get(scheduled.server or "") if scheduled is not None else None
        return server is not None and server.scheduler.policy in LENDING_SERVERS

    def on_core(self, core: str) -> Sequence[ScheduledProcess]:
        """The processes of a core."""
        return self._on_cores.get(core, ())

    @cached_property
    def _on_cores(self) -> Mapping[str, Sequence[ScheduledProcess]]:
        found: dict[str, list[ScheduledProcess]] = {}
        for scheduled in self.scheduled.values():
            found.setdefault(scheduled.core, []).append(scheduled)
        return found

    @cached_property
    def with_uncertain_activations(self) -> frozenset[str]:
        """The processes of executors in loops, and those that they trigger: they may be activated less often."""
        return with_successors(self.system.executor_of_task, self.system, self.dataflow)

    def has_loops_or_waits(self, core: str) -> bool:
        """Whether a process of a core executes at times that its activations do not determine.

        When the rounds of an executor that spins in a loop begin depends on what they do, and when a job that waits for events
        resumes depends on other processes.
        """
        return self.has_waits(core) or any(item.name in self.system.executor_of_task for item in self.on_core(core))

    def has_waits(self, core: str) -> bool:
        """Whether a process of a core waits for events."""
        return bool(self.waiting) and any(item.name in self.waiting for item in self.on_core(core))

    @cached_property
    def awaited_alone(self) -> frozenset[str]:
        """The processes of which each job is activated only by one that has waited for the job before it."""
        awaited = [each for waiting in self.waiting.values() for each in waiting.awaited]
        return frozenset(each.setter for each in awaited if each.gap is None and each.is_last)

    def served(self, core: str, server: str | None) -> Sequence[ScheduledProcess | Server]:
        """Processes and servers on a core itself or in the budget of a server, highest rank first."""
        return self._served.get((core, server), ())

    @cached_property
    def _served(self) -> Mapping[tuple[str, str | None], Sequence[ScheduledProcess | Server]]:
        found: dict[tuple[str, str | None], list[ScheduledProcess | Server]] = {}
        everything: list[ScheduledProcess | Server] = [*self.scheduled.values(), *self.servers.values()]
        for item in everything:
            found.setdefault((item.core, item.server), []).append(item)
        return {key: sorted(items, key=lambda item: item.rank, reverse=True) for key, items in found.items()}

    @property
    def is_everything_scheduled(self) -> bool:
        """Whether each process is scheduled, and allocated once."""
        mapping = self.system.mapping
        return len(self.scheduled) == len(self.system.processes) == len(mapping.tasks) + len(mapping.isrs)

    def mark_unknown(self, name: str, reason: str) -> None:
        """Record why the response time of a process is unknown."""
        self.reasons.setdefault(name, reason)

    def _note_settings(self) -> None:
        settings, notes = self.settings, self.notes
        if settings.scale != 1:
            notes.assume(f"all execution times are multiplied by {float(settings.scale):g}")
        if settings.growth != 1:
            notes.assume(f"all worst-case execution times are multiplied by {float(settings.growth):g}")
        for name, factor in settings.factors.items():
            notes.assume(f"the worst-case execution times of {name} are multiplied by {float(factor):g}")
        if settings.quantile is not None:
            notes.assume(quantile_assumption(settings.quantile))
        for label, value in settings.modes.items():
            notes.assume(f"the mode {label} is always {value}")
        if settings.memory is not MemoryModel.NONE:
            notes.assume("memory accesses do not wait for those of other cores")

    def _schedule(self) -> None:
        """Find core, rank and deadline of each process."""
        if self.alike is not None and self.alike.is_everything_scheduled:
            processes, self.servers = self.system.processes, self.alike.servers
            self.scheduled = {name: replace(item, process=processes[name]) for name, item in self.alike.scheduled.items()}
            return
        scheduling = SchedulingOrder(self.system, self.notes, response_time_limits(self.system), self.servers)
        for allocation in self.system.mapping.tasks:
            try:
                scheduled = scheduling.task(allocation)
                if scheduled.process.name in self.scheduled:
                    self.mark_unknown(scheduled.process.name, "it is allocated more than once")
                self.scheduled[scheduled.process.name] = scheduled
            except UnknownError as error:
                self.mark_unknown(allocation.task, str(error))
        for isr in self.system.mapping.isrs:
            try:
                self.scheduled[isr.isr] = scheduling.isr(isr.isr, isr.controller, isr.priority)
            except UnknownError as error:
                self.mark_unknown(isr.isr, str(error))
        for name in self.system.processes:
            if name not in self.scheduled:
                self.mark_unknown(name, "it is not allocated to a scheduler")

    def _find_demands(self) -> None:
        model = self.demand_model
        for name, scheduled in self.scheduled.items():
            if (same := self._same_demand(scheduled)) is not None:
                self.demands[name] = same
                continue
            try:
                # Its scheduler decides about it, whatever its jobs do.
                if (scheduler := self.deciding(name, scheduled.core)) is not None:
                    self.decisions[name] = model.of_decision(scheduler.overhead, scheduled.core)
                if name in self.unknown_demands:
                    raise UnknownError(self.unknown_demands[name])
                if reason := why_suspended(name, self.system, self.dataflow):
                    raise UnknownError(reason)
                waits = awaited_events(scheduled.process, self.activations)
                demand = (self.executing if waits else model).of_process(scheduled.process, scheduled.core)
                if not states_execution_time(scheduled.process, self.system):
                    raise UnknownError("it has no execution time, and neither have the runnables that it calls")
                if name in self.decisions:
                    demand = MultiframeDemand((*demand.frames, *self.decisions[name].frames))
                if demand.worst > MAX_INPUT:
                    raise UnknownError("its execution time exceeds the supported range of times")
                if waits:
                    self.waiting[name] = WaitingProcess.of(scheduled.process, waits, demand, self.executing, scheduled.core)
                    self.mark_unknown(name, WITHOUT_BOUND)
                else:
                    self.demands[name] = demand
            except UnknownError as error:
                self.notes.warning("ANA004", f"the execution demand of {name!r} is unknown: {error}", scheduled.process)
                self.mark_unknown(name, str(error))

    def _same_demand(self, scheduled: ScheduledProcess) -> MultiframeDemand | None:
        """The demand of a process that is the same in the other context; None if there is none, or if it consists of several ones."""
        name, alike = scheduled.name, self.alike
        if (
            alike is None
            or name in alike.waiting
            or name in alike.decisions
            or alike.system.processes[name] is not scheduled.process
        ):
            return None
        return alike.demands.get(name)

    @cached_property
    def executing(self) -> DemandModel:
        """Converts activities to execution demand, without the time for which jobs wait for events."""
        return DemandModel(self.system, self.notes, self.settings, ignores_waits=True)

    def execution_model(self, process: str) -> DemandModel:
        """Converts activities of a process of known demand to execution demand; what it waits for is apart."""
        return self.executing if process in self.waiting and process in self.demands else self.demand_model

    @cached_property
    def _scheduler_of(self) -> dict[str, str]:
        """The scheduler of each task; the first one if it is allocated more than once."""
        found: dict[str, str] = {}
        for allocation in self.system.mapping.tasks:
            found.setdefault(allocation.task, allocation.scheduler)
        return found

    def decider(self, task: str) -> Scheduler | None:
        """The scheduler that decides when a task is activated or ends, if its decisions take time: its own one, or one above that."""
        scheduler, above = self.system.schedulers.get(self._scheduler_of.get(task, "")), set[str]()
        while scheduler is not None and not scheduler.overhead and scheduler.name not in above:
            above.add(scheduler.name)
            scheduler = self.system.schedulers.get("" if scheduler.parent is None else scheduler.parent.scheduler)
        return scheduler if scheduler is not None and scheduler.overhead else None

    def deciding(self, task: str, core: str) -> Scheduler | None:
        """The same for a task on a core.

        Raises
        ------
        UnknownError : it decides on another core, so that the task waits for what that one executes, or also about other
            schedulers, so that nobody states when.
        """
        scheduler = self.decider(task)
        if scheduler is not None and scheduler.name != self._scheduler_of.get(task):
            raise UnknownError(f"{scheduler.name!r}, above its scheduler, needs time to decide, and nobody states when it does")
        if scheduler is not None and scheduler.executing_core not in (None, core):
            raise UnknownError(
                f"its scheduler {scheduler.name!r} decides on another core, {scheduler.executing_core!r}, which cannot be analysed"
            )
        return scheduler

    @cached_property
    def protection(self) -> dict[str, LockUsage]:
        """What each process uses to keep others off."""
        return {name: self.touching.protection[name] for name in self.scheduled}

    def _find_locks(self) -> None:
        """Find the processes whose critical sections are unknown, and the semaphores at which others than the holder delay."""
        requests: dict[str, set[str]] = {}
        for name, uses in self.protection.items():
            if uses.semaphores and name in self.demands:
                walk = RegionWalk(self.system, RegionKind(), lambda _: 0, self.demand_model.possible_branches, requests)
                try:
                    walk.of(self.scheduled[name].process.activities)
                except UnknownError as error:
                    self._mark_unclear(name, str(error))
        locks = Locks(self.system, self.protection, requests)
        self.open_semaphores = locks.open_semaphores
        for name in sorted(self.open_semaphores):
            self.notes.assume(
                f"the semaphore {name!r} has no priority ceiling and no inheritance: whoever waits for it is also delayed by all "
                "processes above its lowest user"
            )
        remote = self._find_remote_semaphores()
        for name, reason in locks.unclear():
            # Who waits for another core is not kept waiting by priorities.
            if name not in remote:
                self._mark_unclear(name, reason)

    def _mark_unclear(self, name: str, reason: str) -> None:
        scheduled = self.scheduled[name]
        self.unclear_locks.setdefault(name, reason)
        self.notes.warning("ANA003", f"the critical sections of {name!r} cannot be analysed: {reason}", scheduled.process)
        self.mark_unknown(name, reason)

    def _find_remote_semaphores(self) -> frozenset[str]:
        """The processes that can wait at a semaphore for other cores or servers, or for somebody whose core is unknown; marked."""
        found: set[str] = set()
        users: dict[str, list[str]] = {}
        for name, uses in self.touching.protection.items():
            for semaphore in sorted(uses.semaphores) if self.touching.cores_of(name) else ():
                users.setdefault(semaphore, []).append(name)
        spinlocks = spinlocks_of(self.system)
        for semaphore, names in users.items():
            shared = f"it shares the {'spinlock' if semaphore in spinlocks else 'semaphore'} {semaphore!r} with"
            here = [self.scheduled[name] for name in names if name in self.scheduled]
            unknown = next((name for name in names if name not in self.scheduled), None)
            if unknown is not None:
                reason = f"{shared} {unknown!r}, which could not be analysed"
            elif len({(scheduled.core, scheduled.server) for scheduled in here}) > 1:
                reason = f"{shared} other cores or servers"
            else:
                continue
            found |= {scheduled.name for scheduled in here}
            for scheduled in here:
                self._mark_unclear(scheduled.name, reason)
        return frozenset(found)


def _only(values: Collection[T]) -> T | None:
    """The only value; None if there are none or several."""
    return next(iter(values)) if len(values) == 1 else None
