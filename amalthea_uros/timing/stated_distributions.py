"""Whether values follow from what a system states, or depend on distributions that it leaves open.

A range of times says which of them are possible, and not how often each one occurs. What depends on it has bounds, but no
distribution: neither a mean nor a percentile follows. What influences a process is found generously.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import cached_property

from amalthea_uros._internal.graphs import reached
from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.perf.activities import (
    Activity,
    Count,
    Execute,
    ExecutionNeed,
    Group,
    Incomplete,
    Loop,
    Migrate,
    ProbabilitySwitch,
    SemaphoreAccess,
    SenderReceiverAccess,
    ServerCall,
    Switch,
    Trigger,
    WaitEvent,
    called_runnables,
    walk,
)
from amalthea_uros.perf.distributions import Boundaries, Distribution, Statistics, Uniform, highest, lowest
from amalthea_uros.perf.hardware import Latency
from amalthea_uros.perf.stimuli import (
    ArrivalCurve,
    Counter,
    Custom,
    EventTriggered,
    InterProcess,
    Periodic,
    RelativePeriodic,
    Stimulus,
    VariableRate,
)
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.timing.basics.settings import MemoryModel, Settings
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow.chains import events_of
from amalthea_uros.timing.scheduling.allocation import allocated_cores
from amalthea_uros.timing.scheduling.scheduled import is_preemptive

#: By these, processes influence each other in ways that are not followed here: then each one influences all.
_COUPLING = (Migrate, SemaphoreAccess, SenderReceiverAccess, ServerCall, WaitEvent)
_EXECUTION, _ACTIVATION = "execution times", "activations"


@dataclass(frozen=True, slots=True, kw_only=True)
class Open:
    """Values that vary.

    Attributes
    ----------
    what : varies, such as "the execution times of 'Task'"
    is_stated : whether their distribution is stated
    has_mean : whether at least their mean is stated
    """

    what: str
    is_stated: bool = False
    has_mean: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Basis:
    """What the distribution of a quantity follows from.

    Attributes
    ----------
    open : what decides it, and has no stated distribution
    has_mean : whether the mean follows from what is stated all the same
    is_random : whether chance decides values, with a stated distribution or without
    """

    open: tuple[str, ...] = ()
    has_mean: bool = True
    is_random: bool = False

    @property
    def reason(self) -> str:
        """Why the distribution does not follow, "" if it does."""
        if not self.open:
            return ""
        others = f" and of {counted(len(self.open) - 1, 'other')}" if self.open[1:] else ""
        return f"the distribution of {self.open[0]}{others} is not stated"


@dataclass(frozen=True)
class StatedDistributions:
    """What the quantities of a system follow from.

    Attributes
    ----------
    are_phases_open : whether unknown phases are among what is not stated; otherwise each of them is considered elsewhere
    """

    system: System
    settings: Settings
    are_phases_open: bool = False

    def of_process(self, name: str, quantity: str) -> Basis:
        """The basis of a time of the jobs of a process."""
        if quantity == JobMetric.NET_EXECUTION_TIME and name not in self._conditional:
            return _basis((*self._own(name), *self._common), has_mean=True)
        if quantity == JobMetric.ACTIVATE_TO_ACTIVATE and name not in self._activated_by_others:
            return _basis(self._activations(name), has_mean=True)
        return self._of_all([name])

    def of_runnable(self, name: str, quantity: str) -> Basis:
        """The basis of a time of the executions of a runnable."""
        callers = [process for process, bodies in self._bodies.items() if name in bodies]
        if quantity == JobMetric.NET_EXECUTION_TIME and self._conditional.isdisjoint(callers):
            bodies = self._reached(self.system.runnables[name].activities, {name})
            return _basis((*self._varying(bodies.values(), name), *self._common), has_mean=True)
        return self._of_all(callers)

    def of_chain(self, name: str) -> Basis:
        """The basis of the latencies of a chain."""
        found: set[str] = set()
        for each in events_of(self.system.chains[name], self.system):
            process: str = getattr(self.system.events_by_name.get(each), "process", None) or ""
            found |= {process} if process in self.system.processes else set(self.system.processes)
        return self._of_all(found)

    def _of_all(self, processes: Iterable[str]) -> Basis:
        """The basis of what depends on jobs and all that influences them."""
        found = set(reached(processes, self._influencing))
        ordered = [name for name in self.system.processes if name in found]
        varying = [each for name in ordered for each in (*self._own(name), *self._activations(name))]
        return _basis((*varying, *self._common), has_mean=False)

    # What influences what.

    def _influencing(self, name: str) -> Iterator[str]:
        if name in self._conditional or (name in self._activated_by_others and not self._triggering(name)):
            yield from self.system.processes
            return
        yield from self._triggering(name)
        cores = allocated_cores(self.system)
        for other in self.system.processes:
            if cores.get(name, frozenset()) & cores.get(other, frozenset()) and not self._is_below(other, name):
                yield other

    def _is_below(self, other: str, name: str) -> bool:
        """Whether a process never delays another one, which always preempts it immediately."""
        scheduled = self._context.scheduled
        if other not in scheduled or name not in scheduled:
            return False
        one, two = scheduled[other], scheduled[name]
        if one.server is not None or two.server is not None or not is_preemptive(one) or one.rank >= two.rank:
            return False
        activities = (each for body in self._bodies[other].values() for each in walk(body))
        return not any(isinstance(each, Group) and not each.interruptible for each in activities)

    @cached_property
    def _context(self) -> TimingContext:
        return TimingContext.of_scheduling(self.system, self.settings)

    @cached_property
    def _conditional(self) -> frozenset[str]:
        """The processes in whose jobs something depends on what others do."""
        if not self.system.activity_classes.isdisjoint(_COUPLING):
            return frozenset(self.system.processes)
        return frozenset(name for name, bodies in self._bodies.items() if self._is_conditional(name, bodies))

    def _is_conditional(self, name: str, bodies: Mapping[str, tuple[Activity, ...]]) -> bool:
        if name in self.system.executor_of_task:
            return True
        for called, body in bodies.items():
            is_limited = called in self.system.runnables and self.system.runnables[called].condition is not None
            if is_limited or any(_is_conditional(each, called != name) for each in walk(body)):
                return True
        return any(stimulus.condition is not None for stimulus in self._stimuli(name))

    @cached_property
    def _activated_by_others(self) -> frozenset[str]:
        of_others = (InterProcess, EventTriggered)
        return frozenset(
            name for name in self.system.processes if any(isinstance(each, of_others) for each in self._stimuli(name))
        )

    def _triggering(self, name: str) -> list[str]:
        """The processes that trigger another one; none if it is activated by other events."""
        stimuli = self._stimuli(name)
        if not all(isinstance(each, InterProcess) for each in stimuli):
            return []
        wanted = {each.name for each in stimuli}
        return [process for process, fired in self._triggered.items() if not wanted.isdisjoint(fired)]

    @cached_property
    def _triggered(self) -> Mapping[str, frozenset[str]]:
        return {
            name: frozenset(each.stimulus for body in bodies.values() for each in walk(body) if isinstance(each, Trigger))
            for name, bodies in self._bodies.items()
        }

    # What varies.

    def _stimuli(self, process: str) -> list[Stimulus]:
        names = self.system.processes[process].stimuli
        return [self.system.stimuli_by_name[name] for name in names if name in self.system.stimuli_by_name]

    @cached_property
    def _bodies(self) -> Mapping[str, Mapping[str, tuple[Activity, ...]]]:
        """The activities of each process and of the runnables that it calls, by their names; its own with its name."""
        return {
            name: {name: process.activities, **self._reached(process.activities, ())}
            for name, process in self.system.processes.items()
        }

    def _reached(self, activities: tuple[Activity, ...], known: Collection[str]) -> dict[str, tuple[Activity, ...]]:
        """The bodies of the runnables that activities call, directly or not, and of known ones."""
        runnables = self.system.runnables

        def called(body: tuple[Activity, ...]) -> Iterator[str]:
            return (each for each in called_runnables(body) if each in runnables)

        names = reached((*known, *called(activities)), lambda name: called(runnables[name].activities))
        return {name: runnables[name].activities for name in names}

    def _own(self, process: str) -> tuple[Open, ...]:
        """What varies in the jobs of a process."""
        if process in self.system.executor_of_task:
            return (Open(what=f"the iterations of {process!r}"),)
        transmission = self.system.transmissions.get(process)
        spans = () if transmission is None else (transmission.link, transmission.driver, transmission.agent)
        varying = tuple(Open(what=f"the times of {process!r} on its way") for span in spans if span.least != span.most)
        return (*varying, *self._varying(self._bodies[process].values(), process))

    def _varying(self, bodies: Iterable[tuple[Activity, ...]], owner: str) -> tuple[Open, ...]:
        found = (each for body in bodies for activity in walk(body) for each in self._of_activity(activity, owner))
        return tuple(dict.fromkeys(found))

    def _of_activity(self, activity: Activity, owner: str) -> Iterator[Open]:
        what = f"the {_EXECUTION} of {owner!r}"
        match activity:
            case Execute(demand=demand):
                yield from _of_distributions((demand.ticks, *(ticks for _, ticks in demand.by_core_type)), what)
            case ExecutionNeed(needs=needs):
                yield from _of_distributions((ticks for _, ticks in needs), what)
            case Group(ordered=False, activities=(_, _, *_)):
                yield Open(what=f"the order of activities in {owner!r}")
            case ProbabilitySwitch(branches=(_, _, *_)):
                yield Open(what=what, is_stated=True)
            case Incomplete():
                yield Open(what=what)
        times = getattr(activity, "times", None)
        if isinstance(times, float) or (isinstance(times, Count) and times.least < times.most):
            yield Open(what=f"the number of executions in {owner!r}", has_mean=True)
        counter = getattr(activity, "counter", None)
        if isinstance(counter, Counter) and self._is_open(counter):
            yield Open(what=f"the arrivals of {counter.source!r}" if counter.source else f"the phase of a counter in {owner!r}")

    def _is_open(self, counter: Counter) -> bool:
        """Whether it varies which executions take effect, or is unknown without being considered elsewhere."""
        if counter.jitter or (
            counter.arrivals is not None and (counter.arrivals.jitter or counter.arrivals.period is not None)
        ):
            return True
        return not counter.is_phase_known and (self.are_phases_open or not counter.source)

    def _activations(self, process: str) -> Iterator[Open]:
        """What varies between activations of a process."""
        what = f"the {_ACTIVATION} of {process!r}"
        for stimulus in self._stimuli(process):
            match stimulus:
                case Periodic(jitter=jitter):
                    # Jitter does not accumulate: the mean distance is the period.
                    yield from (replace(each, has_mean=True) for each in _of_distances(jitter, what))
                case RelativePeriodic(distance=distance, has_maximum=True):
                    yield from _of_distances(distance, what)
                case RelativePeriodic() | ArrivalCurve() | VariableRate() | Custom():
                    yield Open(what=what)
                case InterProcess(counter=Counter() as counter) | EventTriggered(counter=Counter() as counter) if self._is_open(
                    counter
                ):
                    yield Open(what=what)

    @cached_property
    def _common(self) -> tuple[Open, ...]:
        """What varies for all processes: overheads and memory accesses."""
        demands = [demand for overhead in self.system.os.overheads for _, demand in overhead.services]
        for overhead in self.system.os.overheads:
            isrs = (each for each in (overhead.category_1, overhead.category_2) if each is not None)
            demands += [demand for isr in isrs for demand in (isr.before, isr.after) if demand is not None]
        ticks = [each for demand in demands for each in (demand.ticks, *(ticks for _, ticks in demand.by_core_type))]
        found = list(_of_distributions(ticks, "the overhead of the operating system"))
        for operating_system in self.system.os.systems:
            for scheduler in operating_system.schedulers:
                found += self._varying([scheduler.overhead], scheduler.name)
            for controller in operating_system.interrupt_controllers:
                found += self._varying([controller.overhead], controller.name)
        if self.settings.memory is not MemoryModel.NONE:
            found += _of_distributions(self._latencies(), "the times of memory accesses")
        return tuple(dict.fromkeys(found))

    def _latencies(self) -> Iterator[Distribution[int] | None]:
        accesses = (access.latency for core in self.system.cores.values() for access in core.accesses)
        modules = (getattr(module, "latency", None) for module in self.system.modules.values())
        for latency in (*accesses, *modules, *(memory.latency for memory in self.system.memories.values())):
            yield from (latency.read, latency.write) if isinstance(latency, Latency) else (latency,)


def _is_conditional(activity: Activity, is_in_runnable: bool) -> bool:
    """Whether what an activity does depends on modes, or on how often other processes execute it."""
    counter = getattr(activity, "counter", None)
    return isinstance(activity, Switch | Loop) or (counter is not None and is_in_runnable)


def _of_distances(distribution: Distribution[int] | None, what: str) -> Iterator[Open]:
    """What varies of the times of activations.

    An interval is a uniform distribution in many models, because tools support no other one for it: then it states the ends only.
    """
    for each in _of_distributions([distribution], what):
        yield replace(each, is_stated=False) if isinstance(distribution, Uniform) else each


def _of_distributions(distributions: Iterable[Distribution[int] | None], what: str) -> Iterator[Open]:
    """What varies of the values with some distributions."""
    for each in distributions:
        if each is None or lowest(each) == highest(each) is not None:
            continue
        match each:
            case Boundaries():
                # The sampling says how a simulation draws values, also where nothing is known: 'uniform' is written for that.
                yield Open(what=what)
            case Statistics():
                yield Open(what=what, has_mean=True)
            case _:
                yield Open(what=what, is_stated=True)


def _basis(varying: Iterable[Open], *, has_mean: bool) -> Basis:
    """The basis of what varying values decide.

    Parameters
    ----------
    has_mean : whether the mean follows from the means of the values alone
    """
    found = tuple(varying)
    return Basis(
        open=tuple(dict.fromkeys(each.what for each in found if not each.is_stated)),
        has_mean=has_mean and all(each.has_mean or each.is_stated for each in found),
        is_random=bool(found),
    )
