"""The ordinary load of the controller: its tasks and interrupt service routines."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from itertools import pairwise

from amalthea_uros.perf.distributions import Uniform
from amalthea_uros.perf.software import Activity, Call, IsrCategory, Preemption, Runnable
from amalthea_uros.perf.stimuli import Burst, Counter, InterProcess, Periodic, RelativePeriodic, Single, Synthetic
from amalthea_uros.spec.processes import Isr, Process, Steps, Task
from amalthea_uros.spec.processes import Runnable as RunnableSection
from amalthea_uros.units import Time
from amalthea_uros.uros.demand import Profile
from amalthea_uros.uros.notes import Notes
from amalthea_uros.uros.steps import steps, trigger_name
from amalthea_uros.uros.stimuli import StimulusPool
from amalthea_uros.uros.tasks import PlannedIsr, PlannedTask
from amalthea_uros.uros.work import Work

#: Kind of activation -> least time between two activations.
_KINDS = ("period", "sporadic", "burst", "times", "once")


@dataclass(slots=True)
class Load:
    """Turns sections into planned tasks and ISRs; gathers their runnables and stimuli.

    Attributes
    ----------
    tasks : all tasks of the file by name, for triggers
    """

    profile: Profile
    notes: Notes
    pool: StimulusPool
    tasks: Mapping[str, Task]
    runnables: dict[str, Runnable] = field(default_factory=dict)
    _sections: dict[str, Steps] = field(default_factory=dict)

    def task(self, section: Task, core: str, triggered_by: Iterable[Process]) -> PlannedTask:
        """A task.

        Parameters
        ----------
        triggered_by : the processes that trigger it
        """
        origins = list(triggered_by)
        return PlannedTask(
            name=section.name,
            core=core,
            stimuli=self.stimuli(section, bool(origins)),
            activities=self.activities(section, core),
            period=least_distance(section) or min(filter(None, map(least_distance, origins)), default=None),
            priority=section.priority,
            deadline=section.deadline,
            preemption=Preemption(section.preemption),
            activation_limit=section.activation_limit,
            origin=section.location(),
        )

    def isr(self, section: Isr, core: str) -> PlannedIsr:
        """An interrupt service routine."""
        return PlannedIsr(
            name=section.name,
            core=core,
            stimuli=self.stimuli(section, is_triggered=False),
            activities=self.activities(section, core),
            priority=section.priority,
            category=IsrCategory(f"category {section.category}"),
            origin=section.location(),
        )

    def stimuli(self, section: Process, is_triggered: bool) -> tuple[str, ...]:
        """What activates a process."""
        stated = [kind for kind in _KINDS if section.states(kind)]
        if len(stated) > 1:
            both = " and ".join(map(repr, stated))
            self.notes.error("APP003", f"{section.name!r} has more than one activation: {both}", section.location(stated[1]))
        if not stated and not is_triggered:
            advice = f"Give one of {', '.join(_KINDS)}, or let another process trigger it."
            self.notes.error("APP003", f"nothing activates {section.name!r}", section.location(), advice)
        for key in ("offset", "jitter"):
            if section.states(key) and section.period is None:
                self.notes.error("APP003", f"{key!r} belongs to 'period', which is not stated", section.location(key))
        found = [self._own_stimulus(section)] if stated else []
        if is_triggered:
            found.append(self.pool.add(InterProcess(name=trigger_name(section.name), origin=section.location())))
        return tuple(found)

    def _own_stimulus(self, section: Process) -> str:
        place, name = section.location(), f"activation_of_{section.name}"
        if section.period is not None:
            if section.jitter is None:
                return self.pool.periodic(section.period, section.offset, place)
            jitter = Uniform(lower=0, upper=section.jitter)
            return self.pool.add(Periodic(name=name, period=section.period, offset=section.offset, jitter=jitter, origin=place))
        if section.sporadic is not None:
            least = section.sporadic.min
            most = section.sporadic.max or least
            if most < least:
                self.notes.error("APP003", "'min' is greater than 'max'", section.location("sporadic"))
            return self.pool.add(RelativePeriodic(name=name, distance=Uniform(lower=least, upper=most), origin=place))
        if section.burst is not None:
            burst = section.burst
            length = burst.distance * burst.count
            if length > burst.period:
                self.notes.error("APP003", f"a burst of {section.name!r} is longer than its period", section.location("burst"))
            return self.pool.add(
                Burst(
                    name=name,
                    period=burst.period,
                    length=length,
                    distance=burst.distance,
                    count=burst.count,
                    offset=burst.offset,
                    origin=place,
                )
            )
        if section.times is not None:
            times = section.times
            if max(times.at) >= times.period or sorted(set(times.at)) != times.at:
                message = f"the times of {section.name!r} have to rise and to lie within the period"
                self.notes.error("APP003", message, section.location("times"))
            return self.pool.add(
                Synthetic(name=name, period=times.period, times=tuple(times.at), offset=times.offset, origin=place)
            )
        return self.pool.add(Single(name=name, time=section.once or 0, origin=place))

    def activities(self, section: Process, core: str) -> tuple[Activity, ...]:
        """What a process does."""
        stated = [key for key in ("execution_time", "reads", "writes", "triggers", "locks") if section.states(key)]
        if section.runnables:
            if stated:
                message = f"{section.name!r} has 'runnables', so that {stated[0]!r} belongs to one of them"
                self.notes.error("APP003", message, section.location(stated[0]))
            return tuple(self._call(runnable, core) for runnable in section.runnables)
        if not stated:
            advice = "Give 'execution_time', or 'runnables'."
            self.notes.error("APP003", f"{section.name!r} does nothing", section.location(), advice)
        name = f"{section.name}_Runnable"
        self._add(name, section, core)
        return (Call(runnable=name),)

    def _call(self, section: RunnableSection, core: str) -> Call:
        self._add(section.name, section, core)
        if section.every == 1 and section.first <= 1:
            return Call(runnable=section.name)
        return Call(runnable=section.name, counter=Counter(prescaler=section.every, offset=section.first))

    def _add(self, name: str, section: Steps, core: str) -> None:
        earlier = self._sections.setdefault(name, section)
        if earlier is not section:
            if any(getattr(earlier, key) != getattr(section, key) for key in Steps.model_fields):
                message = f"the function {name!r} is described in another way before"
                self.notes.error("APP002", message, section.location("name"), "Describe it alike, or give it another name.")
            return
        for index, task in enumerate(section.triggers):
            if task not in self.tasks:
                self.notes.unknown("task", task, self.tasks, section.location("triggers", index))
        execute = self.profile.execute([section.execution_time], core, section.location("execution_time"))
        activities = steps(execute, reads=section.reads, writes=section.writes, triggers=section.triggers, locks=section.locks)
        self.runnables[name] = Runnable(name=name, activities=activities, origin=section.location())


def add_load(work: Work) -> None:
    """Add the tasks and interrupt service routines that the file states."""
    description = work.description
    load = Load(work.profile, work.notes, work.pool, {task.name: task for task in description.tasks})
    causes = triggered((*description.tasks, *description.isrs))
    for task in description.tasks:
        work.tasks.append(load.task(task, work.core(task.core, task.location("core")), causes.get(task.name, ())))
    for isr in description.isrs:
        work.isrs.append(load.isr(isr, work.core(isr.core, isr.location("core"))))
    for name in sorted(work.runnables.keys() & load.runnables.keys()):
        message = f"the function {name!r} has the name of one that belongs to the middleware"
        work.notes.error("APP002", message, load.runnables[name].origin, "Give it another name.")
    work.runnables |= load.runnables


def least_distance(section: Process) -> Time | None:
    """The least time between two activations; None if it happens once, or on a trigger."""
    if section.period is not None:
        return section.period
    if section.sporadic is not None:
        return section.sporadic.min
    if section.burst is not None:
        return section.burst.distance
    if section.times is not None:
        times = [*section.times.at, section.times.at[0] + section.times.period]
        return min(after - before for before, after in pairwise(times))
    return None


def triggered(processes: Iterable[Process]) -> dict[str, list[Process]]:
    """For each task that something triggers, the processes that do."""
    found: dict[str, list[Process]] = {}
    for process in processes:
        for section in (process, *process.runnables):
            for task in section.triggers:
                found.setdefault(task, []).append(process)
    return found
