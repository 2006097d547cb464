"""The response times of a system with their timing context; chains and explanations are based on it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import copy
from fractions import Fraction
from functools import cached_property
from operator import attrgetter
from typing import TYPE_CHECKING

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.perf.software import Task
from amalthea_uros.perf.stimuli import EventTriggered, InterProcess
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.load import certain_loads, suppressible
from amalthea_uros.timing.basics.time_base import min_time
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.event_models.models import EventModel
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.timing.scheduling.scheduled import ScheduledProcess
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.core_schedule import CoreSchedule
    from amalthea_uros.analyze.response_times.executor_threads import ExecutorThread
    from amalthea_uros.analyze.response_times.several_cores import MigratingResult


@dataclass
class Solution:
    """Consistent response times and activations of all processes.

    Attributes
    ----------
    event_models : activations, by the names of processes
    sent_again : what of these is sent again because messages are lost, by the names of transmissions
    reasons : why the response time of a process is unknown
    migrating : the tasks that any of several cores executes; `responses` has only those with a core
    schedules : of the cores of which it is known and not too long
    jobs : number of jobs that were examined for it in all passes, those of callbacks of the host among them
    """

    context: TimingContext
    event_models: dict[str, EventModel] = field(default_factory=dict)
    sent_again: Mapping[str, EventModel] = field(default_factory=dict)
    responses: dict[str, Response] = field(default_factory=dict)
    reasons: dict[str, str] = field(default_factory=dict)
    schedules: dict[str, CoreSchedule] = field(default_factory=dict, repr=False)
    migrating: Mapping[str, MigratingResult] = field(default_factory=dict, repr=False)
    jobs: int = 0
    _threads: dict[str, ExecutorThread] = field(default_factory=dict, repr=False)

    @property
    def clients(self) -> Sequence[Solution]:
        """The solution as each client of the middleware sees it; itself if there is one."""
        systems = self.context.system.clients
        return (self,) if len(systems) == 1 else [replace(self, context=_with_system(self.context, each)) for each in systems]

    def schedule(self, core: str, with_slices: bool = False) -> CoreSchedule | None:
        """The schedules of a core; None if they are unknown or too long.

        Parameters
        ----------
        with_slices : whether the execution slices of jobs are needed
        """
        from amalthea_uros.analyze.response_times.core_schedule import CoreSchedule

        found = self.schedules.get(core)
        if found is not None and with_slices and not found.has_slices:
            found = CoreSchedule.of(list(found.tasks.values()), with_slices)
            assert found is not None
            self.schedules[core] = found
        return found

    def is_exact(self, core: str) -> bool:
        """Whether the schedule of a core is known, and its response times are the exact ones."""
        here = self.context.on_core(core)
        return core in self.schedules and all(self.responses[item.name].claim is Claim.EXACT for item in here)

    def processor(self, task: str) -> ExecutorThread:
        """The processor as the thread of an executor sees it; of a solution that is complete.

        Raises
        ------
        UnknownError : it is not scheduled, or something unknown can delay it.
        """
        from amalthea_uros.analyze.response_times.executor_threads import ExecutorThread

        if task not in self._threads:
            self._threads[task] = ExecutorThread.of(task, self)
        return self._threads[task]

    def certain_loads_of(self, cores: Mapping[str, frozenset[str]]) -> Mapping[str, Fraction]:
        """The worst-case load of each core by some processes, as far as it is certain; by the cores on which each can run."""
        return certain_loads(cores, self.context.activations, self.context.demand_model, self._activated_less_often)

    @cached_property
    def certain_loads(self) -> Mapping[str, Fraction]:
        """The same by all processes with a single core."""
        return self.certain_loads_of({item.name: frozenset((item.core,)) for item in self.context.scheduled.values()})

    @cached_property
    def _activated_less_often(self) -> frozenset[str]:
        """The processes that may be activated less often than their stimuli say."""
        context = self.context
        return context.with_uncertain_activations | suppressible(context.system, context.activations)

    def mark_unknown(self, name: str, reason: str) -> None:
        """Record why the response time of a process is unknown."""
        self.reasons.setdefault(name, reason)

    def is_known(self, name: str) -> bool:
        """Whether demand and activations of a process are known."""
        return name in self.context.demands and name in self.event_models

    def is_analysable(self, name: str) -> bool:
        """Whether also the critical sections of a process are known."""
        return self.is_known(name) and name not in self.context.unclear_locks

    def intruder(self, core: str, above_isrs: bool) -> str | None:
        """An unknown process that can delay all tasks of a core, or on request all ISRs, too, whatever their ranks."""
        context = self.context
        # The decisions about a task precede everything else.
        uncounted = (item.name for item in context.on_core(core) if self._is_decided_unknown(item.name))
        return context.touching.intruder(core, above_isrs) or next(uncounted, None)

    def is_closed(self, core: str) -> bool:
        """Whether nothing executes on a core but processes of known ranks, and decisions about them of a known number."""
        return self.intruder(core, above_isrs=False) is None

    def _is_decided_unknown(self, name: str) -> bool:
        """Whether decisions about a process take an unknown time, or are of an unknown number."""
        is_known = name in self.context.decisions and name in self.event_models
        return not is_known and self.context.decider(name) is not None

    @cached_property
    def losing(self) -> frozenset[str]:
        """The tasks of which more jobs can be pending than their activation limits allow; of a solution that is complete."""
        found = []
        for name, response in self.responses.items():
            process = self.context.scheduled[name].process
            # The rounds of an executor are no activations that could be lost.
            if (isinstance(process, Task) and name not in self.context.system.executor_of_task) and (
                response.worst is None
                or self.most_pending(name, self.event_models[name], response.worst) > process.activation_limit
            ):
                found.append(name)
        return frozenset(found)

    def most_pending(self, name: str, events: EventModel, worst: Time) -> int:
        """The maximum number of pending jobs of a process with a bounded response time.

        The bound of a job that waits for one that it has triggered contains the whole response time of that, so that there are no
        more pending jobs of the second process than of the first one.
        """
        most = events.eta_plus(worst)
        for waiting, process in self.context.waiting.items():
            triggered = (each.setter for each in process.awaited if each.gap is None)
            response = self.responses.get(waiting) if name in triggered else None
            if response is not None and response.worst is not None:
                most = min(most, self.event_models[waiting].eta_plus(response.worst))
        return most

    @cached_property
    def external_rates(self) -> Mapping[str, Fraction]:
        """Activations per picosecond that no process triggers, of a solution that is complete."""
        context, found = self.context, {}
        for name, events in self.event_models.items():
            process = context.system.processes[name]
            stimuli = [context.system.stimuli_by_name.get(each) for each in process.stimuli]
            is_triggered = any(isinstance(each, InterProcess | EventTriggered) for each in stimuli)
            # The rounds of an executor are not as frequent as its stimulus.
            found[name] = context.activations.external_rate(process) if is_triggered else events.rate
        return found

    @property
    def rates_without_losses(self) -> Mapping[str, Fraction]:
        """The external rates, without what is sent again because messages are lost."""
        rates = dict(self.external_rates)
        for name, again in self.sent_again.items():
            if rates[name]:
                rates[name] -= again.rate
        return rates

    def depends_on_losses(self, name: str) -> bool:
        """Whether a process, or one of at least its rank on its core, may lose activations: then jobs are missing in the schedule."""
        return bool(self.losing) and (name in self.losing or self.follows_losses(name))

    def follows_losses(self, name: str) -> bool:
        """Whether another process of at least its rank on its core may lose activations."""
        scheduled = self.context.scheduled.get(name)
        if scheduled is None:
            return False
        # The highest of the others is one of the two highest.
        highest = self._losing_on.get(scheduled.core, ())[:2]
        return any(other.name != name and other.rank >= scheduled.rank for other in highest)

    @cached_property
    def _losing_on(self) -> Mapping[str, Sequence[ScheduledProcess]]:
        """The losing tasks of each core, highest rank first."""
        found: dict[str, list[ScheduledProcess]] = {}
        for scheduled in sorted((self.context.scheduled[name] for name in self.losing), key=attrgetter("rank"), reverse=True):
            found.setdefault(scheduled.core, []).append(scheduled)
        return found

    def bcet(self, name: str) -> Time:
        """Best-case execution time of a process, in picoseconds; 0 if it is unknown."""
        demand = self.context.demands.get(name)
        return 0 if demand is None else min_time(demand.best, self.context.time_base(name))


def _with_system(context: TimingContext, client: System) -> TimingContext:
    """A timing context with the system as a client of the middleware sees it, and everything else that is known already."""
    narrowed = copy(context)
    narrowed.system = client
    return narrowed
