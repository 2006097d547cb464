"""The background tasks: those of the controller besides micro-ROS, and its interrupt service routines."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.perf import stimuli as perf
from amalthea_uros.perf.activities import Activity, Call
from amalthea_uros.perf.distributions import Uniform
from amalthea_uros.perf.software import IsrCategory, Preemption, Runnable
from amalthea_uros.spec import processes as spec
from amalthea_uros.units import Time, time_text
from amalthea_uros.uros.application.notes import first_defined
from amalthea_uros.uros.assembly.context import AssemblyContext
from amalthea_uros.uros.assembly.planned import PlannedIsr, PlannedTask, activity_sequence, trigger_name

#: Keys of processes that state an activation.
_ACTIVATIONS = ("period", "sporadic", "burst", "times", "once")


def add_background_tasks(context: AssemblyContext) -> None:
    """Add the tasks and interrupt service routines of the description."""
    description = context.description
    background = BackgroundTasks(context)
    triggers = triggering_processes((*description.tasks, *description.isrs))
    context.tasks += [background.task(task, triggers.get(task.name, ())) for task in description.tasks]
    context.isrs += map(background.isr, description.isrs)
    for name in sorted(context.runnables.keys() & background.runnables.keys()):
        message = f"runnable {name!r} has the name of a runnable of the middleware"
        context.notes.error("APP002", message, background.runnables[name].origin, "Rename it.")
    context.runnables |= background.runnables


@dataclass(slots=True)
class BackgroundTasks:
    """Creates planned tasks and ISRs from their sections, with their runnables and stimuli."""

    context: AssemblyContext
    runnables: dict[str, Runnable] = field(default_factory=dict)
    _sections: dict[str, spec.Steps] = field(default_factory=dict)

    def task(self, section: spec.TaskSection, triggered_by: Sequence[spec.ProcessSection]) -> PlannedTask:
        """A task, with the processes that trigger it."""
        core = self.context.core(section.core, section.location("core"))
        return PlannedTask(
            name=section.name,
            core=core,
            stimuli=self.stimuli(section, bool(triggered_by)),
            activities=self.activities(section, core),
            period=min_interarrival(section) or min(filter(None, map(min_interarrival, triggered_by)), default=None),
            priority=section.priority,
            deadline=section.deadline,
            overhead=section.overhead,
            preemption=Preemption(section.preemption),
            activation_limit=section.activation_limit,
            origin=section.location(),
        )

    def isr(self, section: spec.IsrSection) -> PlannedIsr:
        """An interrupt service routine."""
        core = self.context.core(section.core, section.location("core"))
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
        self._check_activation(section, is_triggered)
        registry, found = self.context.stimuli, []
        if section.period is not None and section.jitter is None:
            found.append(registry.periodic(section.period, section.offset, section.location()))
        elif (stimulus := self.stimulus(section)) is not None:
            found.append(registry.add(stimulus))
        if is_triggered:
            found.append(registry.add(perf.InterProcess(name=trigger_name(section.name), origin=section.location())))
        return tuple(found)

    def _check_activation(self, section: spec.ProcessSection, is_triggered: bool) -> None:
        notes, kinds = self.context.notes, [kind for kind in _ACTIVATIONS if getattr(section, kind) is not None]
        if len(kinds) > 1:
            message = f"{section.name!r} has more than one activation: {' and '.join(map(repr, kinds))}"
            notes.error("APP003", message, section.location(kinds[1]), "Remove all but one.")
        if not kinds and not is_triggered:
            trigger = ", or list it under 'triggers' of another process" if isinstance(section, spec.TaskSection) else ""
            advice = f"Set one of {', '.join(_ACTIVATIONS)}{trigger}; e.g. 'period: 10 ms'."
            notes.error("APP003", f"{section.name!r} has no activation", section.location(), advice)
        for key in ("offset", "jitter"):
            if section.states(key) and section.period is None:
                message = f"{key!r} of {section.name!r} has no effect without 'period'"
                notes.error("APP003", message, section.location(key), f"Set 'period', or remove {key!r}.")

    def stimulus(self, section: spec.ProcessSection) -> perf.Stimulus | None:
        """The stimulus of the first activation that a process states; None if it states none."""
        name, origin = f"activation_of_{section.name}", section.location()
        if section.period is not None:
            late = Uniform(lower=0, upper=section.jitter or 0)
            return perf.Periodic(name=name, period=section.period, offset=section.offset, jitter=late, origin=origin)
        if (sporadic := section.sporadic) is not None:
            lower, upper = sporadic.min, sporadic.max or sporadic.min
            if upper < lower:
                message = f"'min' ({time_text(lower)}) is greater than 'max' ({time_text(upper)})"
                self.context.notes.error("APP003", message, section.location("sporadic"), "Exchange the values.")
            distance = Uniform(lower=lower, upper=upper)
            return perf.RelativePeriodic(name=name, distance=distance, has_maximum=sporadic.max is not None, origin=origin)
        if (burst := section.burst) is not None:
            length = burst.distance * burst.count
            if length > burst.period:
                message = (
                    f"the burst of {section.name!r} ({time_text(length)}) is longer than its period ({time_text(burst.period)})"
                )
                advice = "Increase 'period', or reduce 'count' or 'distance'."
                self.context.notes.error("APP003", message, section.location("burst"), advice)
            return perf.Burst(
                name=name,
                period=burst.period,
                length=length,
                distance=burst.distance,
                count=burst.count,
                offset=burst.offset,
                origin=origin,
            )
        if (times := section.times) is not None:
            if max(times.at) >= times.period or sorted(set(times.at)) != times.at:
                message = f"the times of {section.name!r} must be strictly increasing and less than the period"
                advice = f"Sort the times, and remove duplicates and times from {time_text(times.period)} on."
                self.context.notes.error("APP003", message, section.location("times"), advice)
            return perf.Synthetic(name=name, period=times.period, times=tuple(times.at), offset=times.offset, origin=origin)
        return None if section.once is None else perf.Single(name=name, time=section.once, origin=origin)

    def activities(self, section: spec.ProcessSection, core: str) -> tuple[Activity, ...]:
        """The activities of a process: calls of its runnables."""
        keys = [key for key in spec.Steps.model_fields if section.states(key)]
        if section.runnables:
            if keys:
                message = f"{section.name!r} has 'runnables', so {keys[0]!r} must be set for one of them"
                advice = f"Move {keys[0]!r} to a runnable."
                self.context.notes.error("APP003", message, section.location(keys[0]), advice)
            return tuple(self._call(runnable, core) for runnable in section.runnables)
        if not keys and section.overhead is not None:
            return ()
        if not keys:
            advice = "Set 'execution_time' or 'runnables'; or 'overhead', for an empty process."
            self.context.notes.error("APP003", f"{section.name!r} does nothing", section.location(), advice)
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
                self.context.notes.error(
                    "APP002", message, section.location("name"), "Make both definitions equal, or rename one."
                )
            return
        tasks = [task.name for task in self.context.description.tasks]
        for index, task in enumerate(section.triggers):
            if task not in tasks:
                self.context.notes.undefined("task", task, tasks, section.location("triggers", index))
        self.runnables[name] = Runnable(
            name=name,
            activities=activity_sequence(
                self.context.converter.execute([section.execution_time], core, section.location("execution_time")),
                reads=section.reads,
                writes=section.writes,
                triggers=section.triggers,
                locks=section.locks,
            ),
            origin=section.location(),
        )


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
