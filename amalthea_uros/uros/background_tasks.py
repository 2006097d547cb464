"""The background tasks: those of the controller besides micro-ROS, and its interrupt service routines."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from itertools import pairwise

from amalthea_uros.perf import stimuli as perf
from amalthea_uros.perf.activities import Activity, Call
from amalthea_uros.perf.distributions import Uniform
from amalthea_uros.perf.software import IsrCategory, Preemption, Runnable
from amalthea_uros.spec import processes as spec
from amalthea_uros.units import Time, time_text
from amalthea_uros.uros.application.notes import Notes, first_defined
from amalthea_uros.uros.assembly.context import AssemblyContext
from amalthea_uros.uros.assembly.demand import DemandConverter
from amalthea_uros.uros.assembly.planned import PlannedIsr, PlannedTask, StimulusRegistry, activity_sequence, trigger_name


@dataclass(slots=True)
class BackgroundTasks:
    """Creates planned tasks and ISRs from their sections, with their runnables and stimuli.

    Attributes
    ----------
    tasks : all tasks of the description by name, for triggers
    """

    converter: DemandConverter
    notes: Notes
    registry: StimulusRegistry
    tasks: Mapping[str, spec.TaskSection]
    runnables: dict[str, Runnable] = field(default_factory=dict)
    _sections: dict[str, spec.Steps] = field(default_factory=dict)

    def task(self, section: spec.TaskSection, core: str, triggered_by: Iterable[spec.ProcessSection]) -> PlannedTask:
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
            period=min_interarrival(section) or min(filter(None, map(min_interarrival, origins)), default=None),
            priority=section.priority,
            deadline=section.deadline,
            overhead=section.overhead,
            preemption=Preemption(section.preemption),
            activation_limit=section.activation_limit,
            origin=section.location(),
        )

    def isr(self, section: spec.IsrSection, core: str) -> PlannedIsr:
        """An interrupt service routine."""
        return PlannedIsr(
            name=section.name,
            core=core,
            stimuli=self.stimuli(section, is_triggered=False),
            activities=self.activities(section, core),
            priority=section.priority,
            category=IsrCategory(f"category {section.category}"),
            overhead=section.overhead,
            origin=section.location(),
        )

    def stimuli(self, section: spec.ProcessSection, is_triggered: bool) -> tuple[str, ...]:
        """The names of the stimuli that activate a process."""
        kinds = [kind for kind in _ACTIVATIONS if getattr(section, kind) is not None]
        self._check_activation(section, kinds, is_triggered)
        found = [_ACTIVATIONS[kinds[0]](self, section)] if kinds else []
        if is_triggered:
            found.append(self.registry.add(perf.InterProcess(name=trigger_name(section.name), origin=section.location())))
        return tuple(found)

    def _check_activation(self, section: spec.ProcessSection, kinds: list[str], is_triggered: bool) -> None:
        if len(kinds) > 1:
            message = f"{section.name!r} has more than one activation: {' and '.join(map(repr, kinds))}"
            self.notes.error("APP003", message, section.location(kinds[1]), "Remove all but one.")
        if not kinds and not is_triggered:
            trigger = ", or list it under 'triggers' of another process" if isinstance(section, spec.TaskSection) else ""
            advice = f"Set one of {', '.join(_ACTIVATIONS)}{trigger}; e.g. 'period: 10 ms'."
            self.notes.error("APP003", f"{section.name!r} has no activation", section.location(), advice)
        for key in ("offset", "jitter"):
            if section.states(key) and section.period is None:
                message = f"{key!r} of {section.name!r} has no effect without 'period'"
                self.notes.error("APP003", message, section.location(key), f"Set 'period', or remove {key!r}.")

    def periodic(self, section: spec.ProcessSection) -> str:
        """The stimulus of `period`."""
        assert section.period is not None
        if section.jitter is None:
            return self.registry.periodic(section.period, section.offset, section.location())
        return self.registry.add(
            perf.Periodic(
                name=_stimulus_name(section),
                period=section.period,
                offset=section.offset,
                jitter=Uniform(lower=0, upper=section.jitter),
                origin=section.location(),
            )
        )

    def sporadic(self, section: spec.ProcessSection) -> str:
        """The stimulus of `sporadic`."""
        assert section.sporadic is not None
        lower, upper = section.sporadic.min, section.sporadic.max or section.sporadic.min
        if upper < lower:
            message = f"'min' ({time_text(lower)}) is greater than 'max' ({time_text(upper)})"
            self.notes.error("APP003", message, section.location("sporadic"), "Exchange the values.")
        distance = Uniform(lower=lower, upper=upper)
        return self.registry.add(
            perf.RelativePeriodic(
                name=_stimulus_name(section),
                distance=distance,
                has_maximum=section.sporadic.max is not None,
                origin=section.location(),
            )
        )

    def burst(self, section: spec.ProcessSection) -> str:
        """The stimulus of `burst`."""
        burst = section.burst
        assert burst is not None
        length = burst.distance * burst.count
        if length > burst.period:
            message = (
                f"the burst of {section.name!r} ({time_text(length)}) is longer than its period ({time_text(burst.period)})"
            )
            advice = "Increase 'period', or reduce 'count' or 'distance'."
            self.notes.error("APP003", message, section.location("burst"), advice)
        return self.registry.add(
            perf.Burst(
                name=_stimulus_name(section),
                period=burst.period,
                length=length,
                distance=burst.distance,
                count=burst.count,
                offset=burst.offset,
                origin=section.location(),
            )
        )

    def times(self, section: spec.ProcessSection) -> str:
        """The stimulus of `times`."""
        times = section.times
        assert times is not None
        if max(times.at) >= times.period or sorted(set(times.at)) != times.at:
            message = f"the times of {section.name!r} must be strictly increasing and less than the period"
            advice = f"Sort the times, and remove duplicates and times from {time_text(times.period)} on."
            self.notes.error("APP003", message, section.location("times"), advice)
        return self.registry.add(
            perf.Synthetic(
                name=_stimulus_name(section),
                period=times.period,
                times=tuple(times.at),
                offset=times.offset,
                origin=section.location(),
            )
        )

    def once(self, section: spec.ProcessSection) -> str:
        """The stimulus of `once`."""
        return self.registry.add(perf.Single(name=_stimulus_name(section), time=section.once or 0, origin=section.location()))

    def activities(self, section: spec.ProcessSection, core: str) -> tuple[Activity, ...]:
        """The activities of a process: calls of its runnables."""
        keys = [key for key in spec.Steps.model_fields if section.states(key)]
        if section.runnables:
            if keys:
                message = f"{section.name!r} has 'runnables', so {keys[0]!r} must be set for one of them"
                advice = f"Move {keys[0]!r} to a runnable."
                self.notes.error("APP003", message, section.location(keys[0]), advice)
            return tuple(self._call(runnable, core) for runnable in section.runnables)
        if not keys and section.overhead is not None:
            return ()
        if not keys:
            advice = "Set 'execution_time' or 'runnables'; or 'overhead', for an empty process."
            self.notes.error("APP003", f"{section.name!r} does nothing", section.location(), advice)
        name = f"{section.name}_Runnable"
        self._add(name, section, core)
        return (Call(runnable=name),)

    def _call(self, section: spec.RunnableSection, core: str) -> Call:
        self._add(section.name, section, core)
        if section.every == 1 and section.first <= 1:
            return Call(runnable=section.name)
        return Call(runnable=section.name, counter=perf.Counter(prescaler=section.every, offset=section.first))

    def _add(self, name: str, section: spec.Steps, core: str) -> None:
        first = self._sections.setdefault(name, section)
        if first is not section:
            if any(getattr(first, key) != getattr(section, key) for key in spec.Steps.model_fields):
                message = f"runnable {name!r} is defined twice with different contents{first_defined(first.location())}"
                self.notes.error("APP002", message, section.location("name"), "Make both definitions equal, or rename one.")
            return
        for index, task in enumerate(section.triggers):
            if task not in self.tasks:
                self.notes.undefined("task", task, self.tasks, section.location("triggers", index))
        self.runnables[name] = Runnable(
            name=name,
            activities=activity_sequence(
                self.converter.execute([section.execution_time], core, section.location("execution_time")),
                reads=section.reads,
                writes=section.writes,
                triggers=section.triggers,
                locks=section.locks,
            ),
            origin=section.location(),
        )


#: Kind of activation, by the key of a process -> creates its stimulus.
_ACTIVATIONS: Mapping[str, Callable[[BackgroundTasks, spec.ProcessSection], str]] = {
    "period": BackgroundTasks.periodic,
    "sporadic": BackgroundTasks.sporadic,
    "burst": BackgroundTasks.burst,
    "times": BackgroundTasks.times,
    "once": BackgroundTasks.once,
}


def _stimulus_name(section: spec.ProcessSection) -> str:
    return f"activation_of_{section.name}"


def add_background_tasks(context: AssemblyContext) -> None:
    """Add the tasks and interrupt service routines of the description."""
    description = context.description
    background = BackgroundTasks(
        context.converter, context.notes, context.stimuli, {task.name: task for task in description.tasks}
    )
    triggers = triggering_processes((*description.tasks, *description.isrs))
    for task in description.tasks:
        core = context.core(task.core, task.location("core"))
        context.tasks.append(background.task(task, core, triggers.get(task.name, ())))
    for isr in description.isrs:
        context.isrs.append(background.isr(isr, context.core(isr.core, isr.location("core"))))
    for name in sorted(context.runnables.keys() & background.runnables.keys()):
        message = f"runnable {name!r} has the name of a runnable of the middleware"
        context.notes.error("APP002", message, background.runnables[name].origin, "Rename it.")
    context.runnables |= background.runnables


def min_interarrival(section: spec.ProcessSection) -> Time | None:
    """The minimum time between two activations; None for a single activation or a trigger."""
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


def triggering_processes(processes: Iterable[spec.ProcessSection]) -> dict[str, list[spec.ProcessSection]]:
    """For each task that is triggered, the processes that trigger it."""
    found: dict[str, list[spec.ProcessSection]] = {}
    for process in processes:
        for section in (process, *process.runnables):
            for task in section.triggers:
                found.setdefault(task, []).append(process)
    return found
