"""What a process can touch of which something is unknown: cores, other processes, and data; and what makes its times unknown.

A process that cannot be analysed, or not be simulated, makes everything unknown that it can touch. These are its ways to do so, one
function each; analyses, simulation and chains ask them instead of deciding each for itself where an unknown process has an effect.

A callback in a task of its own, or one that a periodic executor calls, is suspended while it publishes a reliable message, like any
other (micro-ROS/rmw_microxrcedds, src/rmw_publish.c). Its job does not end meanwhile, and afterwards it delays others later than its
activation says, so that neither its response time nor those of processes of lower priority are known.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cached_property

from amalthea_uros._internal.graphs import reached
from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import Call, Incomplete, Migrate, Trigger
from amalthea_uros.perf.conditions import read_by
from amalthea_uros.perf.network import Transmission, Wait
from amalthea_uros.perf.software import Isr
from amalthea_uros.perf.stimuli import InterProcess
from amalthea_uros.perf.system import System
from amalthea_uros.timing.blocking.critical_sections import LockUsage, protection_of
from amalthea_uros.timing.dataflow.links import Dataflow, DirectLink, LinkKind, reads, writes
from amalthea_uros.timing.jobs.executed import executed
from amalthea_uros.timing.scheduling.allocation import allocated_cores, scheduler_cores
from amalthea_uros.timing.scheduling.scheduled import ScheduledProcess
from amalthea_uros.units import time_text


def with_successors(processes: Iterable[str], system: System, dataflow: Dataflow) -> frozenset[str]:
    """Some processes, and those that they trigger, directly or by others."""

    def triggered(name: str) -> Iterator[str]:
        stimuli = _triggered(name, system, dataflow)
        return (other.name for other in system.processes.values() if not stimuli.isdisjoint(other.stimuli))

    return frozenset(reached((name for name in processes if name in system.processes), triggered))


def _triggered(name: str, system: System, dataflow: Dataflow) -> frozenset[str]:
    """The stimuli that the jobs of a process trigger."""
    try:
        positions = dataflow.events.positions(name)
    except UnknownError:
        return frozenset(stimulus.name for stimulus in system.stimuli.stimuli if isinstance(stimulus, InterProcess))
    return frozenset(position.activity.stimulus for position in positions if isinstance(position.activity, Trigger))


_WAYS_OUT = "give the executor its loop, or state 'reliable: {waits: false}' if the port does not wait"


def awaited(process: str, system: System, dataflow: Dataflow) -> Iterator[Transmission | Wait]:
    """The messages whose acknowledgements the jobs of a process wait for."""
    sent = [each for each in system.network.transmissions if each.waits]
    if sent:
        fired = {firing.stimulus for firing in dataflow.firings(process)}
        yield from (each for each in sent if not fired.isdisjoint(system.processes[each.name].stimuli))
    if system.network.waits:
        activities = executed(system.processes[process].activities, system)
        called = {activity.runnable for activity in activities if isinstance(activity, Call)}
        yield from (each for each in system.network.waits if each.runnable in called)


def why_suspended(process: str, system: System, dataflow: Dataflow) -> str:
    """Why the jobs of a process take longer than they execute; "" if they do not, or if the analysis of executors bounds it."""
    if process in system.executor_of_task:
        return ""
    for message in awaited(process, system, dataflow):
        most = f" up to {time_text(message.timeout)}" if isinstance(message, Wait) and message.timeout is not None else ""
        return (
            f"it waits{most} for the acknowledgement of {message.topic!r}, for which the analysis has no bound outside an executor "
            f"with a loop; {_WAYS_OUT}"
        )
    return ""


#: What the bridge calls a migration without a target.
_INCOMPLETE_MIGRATION = "an incomplete EnforcedMigration"


@dataclass(frozen=True)
class Touching:
    """What the processes of a system can touch.

    Attributes
    ----------
    scheduled : the processes whose core and rank are known
    """

    system: System
    scheduled: Mapping[str, ScheduledProcess]
    dataflow: Dataflow

    # Cores.

    def cores_of(self, name: str) -> frozenset[str]:
        """The cores that a process may execute on; all if it does not state one, none if nothing activates it there."""
        return self._cores[name]

    @cached_property
    def _cores(self) -> Mapping[str, frozenset[str]]:
        system, stated = self.system, allocated_cores(self.system)
        mapped = {task.task for task in system.mapping.tasks} | {isr.isr for isr in system.mapping.isrs}
        everywhere = frozenset(system.cores)
        found = {}
        for name, process in system.processes.items():
            if name not in mapped and not process.stimuli:
                found[name] = frozenset[str]()  # neither a scheduler nor a stimulus knows it
                continue
            own = stated.get(name, everywhere)
            targets = map(self._cores_of_target, self._targets.get(name, ()))
            found[name] = own.union(self._deciding_cores(name), *targets) & everywhere
        return found

    @cached_property
    def _targets(self) -> Mapping[str, tuple[str | None, ...]]:
        """The schedulers to which each process migrates; None if one is not stated."""
        if self.system.activity_classes.isdisjoint((Migrate, Incomplete)):
            return {}
        found = {}
        for name, process in self.system.processes.items():
            targets: list[str | None] = []
            for activity in executed(process.activities, self.system):
                match activity:
                    case Migrate(scheduler=scheduler):
                        targets.append(scheduler)
                    case Incomplete(reason=reason) if reason == _INCOMPLETE_MIGRATION:
                        targets.append(None)
            if targets:
                found[name] = tuple(targets)
        return found

    def _cores_of_target(self, scheduler: str | None) -> Iterable[str]:
        return (scheduler_cores(scheduler, self.system) if scheduler is not None else ()) or self.system.cores

    def intruder(self, core: str, above_isrs: bool) -> str | None:
        """A process that may execute on a core with an unknown rank: before all tasks or, on request, before all ISRs there."""
        return self._intruders.get((core, above_isrs))

    @cached_property
    def _intruders(self) -> Mapping[tuple[str, bool], str]:
        found: dict[tuple[str, bool], str] = {}
        for name in self.system.processes:
            for core in sorted(self._intruded_by(name)):
                found.setdefault((core, False), name)
                if self._is_above_isrs(name, core):
                    found.setdefault((core, True), name)
        return found

    def intruders(self, core: str) -> Iterator[str]:
        """All processes that may execute on a core with an unknown rank."""
        return (name for name in self.system.processes if core in self._intruded_by(name))

    def _intruded_by(self, name: str) -> frozenset[str]:
        """The cores on which the rank of a process is unknown."""
        scheduled = self.scheduled.get(name)
        if scheduled is None or len(self._schedulers.get(name, ())) > 1:
            return self.cores_of(name)
        targets = {core for target in self._targets.get(name, ()) for core in self._cores_of_target(target)}
        if scheduled.core in targets or (targets and self._decides(name, scheduled.core)):
            return self.cores_of(name)  # its rank, or how often its scheduler decides, is unknown even on its own core
        return self.cores_of(name) - {scheduled.core}

    @cached_property
    def _schedulers(self) -> Mapping[str, list[str]]:
        """The schedulers to which each task is allocated."""
        found: dict[str, list[str]] = {}
        for allocation in self.system.mapping.tasks:
            found.setdefault(allocation.task, []).append(allocation.scheduler)
        return found

    def _is_above_isrs(self, name: str, core: str) -> bool:
        """Whether a process of unknown rank delays interrupt service routines of a core, too."""
        uses = self.protection[name]
        return isinstance(self.system.processes[name], Isr) or uses.has_non_interruptible_group or self._decides(name, core)

    def _decides(self, name: str, core: str) -> bool:
        """Whether decisions of schedulers about a process take time on a core: they precede everything else."""
        return core in self._deciding_cores(name)

    def _deciding_cores(self, name: str) -> Iterator[str]:
        """The cores that execute the decisions about a process, if these take time."""
        for each in (*self._schedulers.get(name, ()), *self._targets.get(name, ())):
            scheduler = self.system.schedulers.get(each or "")
            if scheduler is not None and scheduler.overhead:
                executing = scheduler.executing_core
                yield from (executing,) if executing is not None else scheduler_cores(scheduler.name, self.system)

    # Other processes.

    @cached_property
    def protection(self) -> Mapping[str, LockUsage]:
        """What each process uses to keep others off."""
        return {name: protection_of(process, self.system) for name, process in self.system.processes.items()}

    def by_cores(self, name: str) -> Iterator[str]:
        """The processes that may share a core with a process."""
        own = self.cores_of(name)
        return (other for other in self.system.processes if not own.isdisjoint(self.cores_of(other)))

    def by_semaphores(self, name: str) -> Iterator[str]:
        """The processes that may wait for a process at a semaphore."""
        own = self.protection[name].semaphores
        return (other for other, uses in self.protection.items() if not own.isdisjoint(uses.semaphores))

    def by_links(self, name: str) -> Iterator[str]:
        """The processes that a process may activate, or that wait for what it does, or decide by it what they do."""
        try:
            for link in self._links.get(name, ()):
                if link.kind is not LinkKind.DATA or link.name in self._decisive(link.target):
                    yield link.target
        except UnknownError:
            yield from self.system.processes  # it is unknown what some process does

    @cached_property
    def _links(self) -> Mapping[str, list[DirectLink]]:
        found: dict[str, list[DirectLink]] = {}
        for link in self.dataflow.direct():
            found.setdefault(link.source, []).append(link)
        for other in self.system.processes:
            for label in self._conditions_of_stimuli(other):
                for name in filter(other.__ne__, self.writers(label)):
                    found.setdefault(name, []).append(DirectLink(LinkKind.DATA, name, label, other))
        return found

    def _decisive(self, name: str) -> frozenset[str]:
        """The mode labels and channels on which it depends what a process executes, and when."""
        inside = (each for position in self.dataflow.events.positions(name) if position.conditions for each in reads(position))
        return frozenset((*inside, *self._conditions_of_stimuli(name)))

    def _conditions_of_stimuli(self, name: str) -> Iterator[str]:
        for stimulus in map(self.system.stimuli_by_name.get, self.system.processes[name].stimuli):
            condition = getattr(stimulus, "condition", None)
            if condition is not None:
                yield from read_by(condition)

    def writers(self, label: str) -> Iterator[str]:
        """The processes that may write a label, mode label or channel: also those of which nobody knows what they write."""
        for name in self.system.processes:
            try:
                if self.cores_of(name) and label in self.dataflow.by_name(name, writes):
                    yield name
            except UnknownError:
                yield name

    def closure(self, seeds: Iterable[str]) -> Mapping[str, str]:
        """The processes that some processes can touch, directly or through others, each with the one from which that comes."""
        relations: tuple[Callable[[str], Iterator[str]], ...] = (self.by_cores, self.by_semaphores, self.by_links)
        origins = {name: name for name in seeds}
        pending = list(origins)
        for name in pending:
            for touched in (touched for relation in relations for touched in relation(name)):
                if touched not in origins:
                    origins[touched] = origins[name]
                    pending.append(touched)
        return origins
