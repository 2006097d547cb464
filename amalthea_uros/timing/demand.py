"""The execution demand of processes: their activity graphs walked, ticks turned into time on a core.

A tick is often no whole number of picoseconds. So that nothing is rounded before the end, the demand on a core is counted in grains:
the greatest parts of a picosecond of which a tick is a whole number (a third of one at 300 MHz). Of branches the worst one counts in
the worst case and the best one in the best case; a call that is executed every n-th time only stays a part of its own, so that a job
without it does not pay for it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from math import ceil, floor

from amalthea_uros.analyze.response_times.kernel import LIMIT
from amalthea_uros.perf.distributions import Distribution, highest, lowest
from amalthea_uros.perf.os import Scheduler
from amalthea_uros.perf.software import (
    Activity,
    Call,
    Count,
    Demand,
    Execute,
    ExecutionNeed,
    Group,
    Isr,
    LabelAccess,
    Loop,
    Migrate,
    ProbabilitySwitch,
    Process,
    Runnable,
    Switch,
    WaitEvent,
    walk,
)
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.perf.system import System
from amalthea_uros.timing.means import mean
from amalthea_uros.timing.memory import MemoryAccess, count_of
from amalthea_uros.timing.modes import holds
from amalthea_uros.timing.multiframe import Cost, Part
from amalthea_uros.timing.notes import Notes, UnknownDemandError
from amalthea_uros.timing.overheads import Overheads
from amalthea_uros.timing.settings import Memory, Settings
from amalthea_uros.units import Frequency, time_of_ticks

#: Finer grains would bring times near to the limits of whole numbers of 64 bits.
MOST_GRAINS = 1000


@dataclass(slots=True)
class Demands:
    """The demand of the processes of a system."""

    system: System
    notes: Notes
    settings: Settings = field(default_factory=Settings)
    memory: MemoryAccess = field(init=False)
    overheads: Overheads = field(init=False)
    _known: dict[tuple[str, str], tuple[Part, ...]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.memory = MemoryAccess(self.system, self.notes, self.frequency)
        self.overheads = Overheads(self.system)

    def grains(self, core: str) -> int:
        """How many grains a picosecond has on a core; 1 where they would be too small, and then demand is rounded outwards."""
        frequency = self.frequency(core)
        if frequency is None:
            return 1
        fineness = (time_of_ticks(1, frequency) * self.settings.scale).denominator
        return fineness if fineness <= MOST_GRAINS else 1

    def frequency(self, core: str) -> Frequency | None:
        """The clock of a core, None if it is not known."""
        if core in self.settings.frequencies:
            return self.settings.frequencies[core]
        clock = self.system.clocks.get(self.system.cores[core].clock or "")
        return clock.frequency if clock is not None and clock.frequency else None

    def cost(self, process: Process, core: str) -> Cost:
        """What the jobs of a process cost on a core, in its grains.

        Raises
        ------
        UnknownDemandError : something in it has no bound, or the core no clock.
        """
        parts = self._parts(process.activities, core, ())
        if self.settings.memory is Memory.IMPLICIT:
            parts += self._copies(process.activities, core)
        if isinstance(process, Isr):
            parts += [self._ticks(demand, core) for demand in self.overheads.of_isr(process, core)]
        return Cost(_scaled(_summed(parts), self.settings.factors.get(process.name)))

    def piece(self, process: Process, activities: Sequence[Activity], core: str) -> Cost:
        """What some activities of a process cost, without what comes before and behind all of them; raises as `cost`."""
        return Cost(_scaled(_summed(self._parts(activities, core, ())), self.settings.factors.get(process.name)))

    def decision(self, scheduler: Scheduler, core: str) -> Cost:
        """What one decision of a scheduler costs; raises as `cost`."""
        return Cost(_summed(self._parts(scheduler.overhead, core, ())))

    def _copies(self, activities: Sequence[Activity], core: str) -> list[Part]:
        """The copies of all labels that a process reads, before it starts, and of those that it writes, at its end."""
        found = dict.fromkeys((access.label, access.kind) for access in self._accesses(activities, ()))
        self.notes.assume("each label is copied once at the start and once at the end of a job that reads or writes it")
        grains = self.settings.scale * self.grains(core)
        return [self.memory.part(core, label, kind, count_of(1), grains) for label, kind in found]

    def _accesses(self, activities: Sequence[Activity], above: tuple[str, ...]) -> Iterator[LabelAccess]:
        for activity in walk(tuple(activities)):
            if isinstance(activity, LabelAccess):
                yield activity
            elif isinstance(activity, Call) and activity.runnable in self.system.runnables and activity.runnable not in above:
                yield from self._accesses(self.system.runnables[activity.runnable].activities, (*above, activity.runnable))

    def _parts(self, activities: Iterable[Activity], core: str, above: tuple[str, ...]) -> list[Part]:
        return [part for activity in activities for part in self._with_services(activity, core, above)]

    def _with_services(self, activity: Activity, core: str, above: tuple[str, ...]) -> Iterator[Part]:
        """The parts of one activity, and of the services of the operating system that it calls."""
        yield from self._of(activity, core, above)
        for demand in self.overheads.of_activity(activity, core):
            yield self._ticks(demand, core)

    def _of(self, activity: Activity, core: str, above: tuple[str, ...]) -> Sequence[Part]:
        """The parts of one activity; what takes no time has none."""
        match activity:
            case Execute(demand=demand):
                return [self._ticks(demand, core)]
            case ExecutionNeed(needs=needs):
                scale = self.settings.scale
                return [self._time(need, self._ticks_per_unit(name, core) * scale, core) for name, need in needs]
            case LabelAccess(label=label, kind=kind, times=times) if self.settings.memory is Memory.EXPLICIT:
                return [self.memory.part(core, label, kind, count_of(times), self.settings.scale * self.grains(core))]
            case Call():
                return self._call(activity, core, above)
            case Group(activities=inner):
                return self._parts(inner, core, above)
            case ProbabilitySwitch(branches=branches):
                weights = [branch.weight for branch in branches]
                return _one_of([self._parts(branch.activities, core, above) for branch in branches], weights)
            case Switch():
                alternatives = [self._parts(inner, core, above) for inner in self._possible(activity)]
                return _one_of(alternatives, [1.0] * len(alternatives))
            case Loop(condition=condition):
                if holds(condition, self.settings.modes) is False:
                    return []
                raise UnknownDemandError("there is a loop, and nothing says how often it is repeated at most")
            case WaitEvent():
                raise UnknownDemandError("it waits for events, and nothing says how long at most")
            case Migrate():
                raise UnknownDemandError("it moves to another scheduler, for which there is no analysis")
        return []

    def _possible(self, switch: Switch) -> list[tuple[Activity, ...]]:
        """The branches that may be taken, given the modes that are known."""
        found: list[tuple[Activity, ...]] = []
        for case in switch.cases:
            value = holds(case.condition, self.settings.modes)
            if value is not False:
                found.append(case.activities)
            if value:
                return found
        return [*found, switch.default or ()]

    def _ticks(self, demand: Demand, core: str) -> Part:
        ticks = dict(demand.by_core_type).get(self.system.cores[core].type or "", demand.ticks)
        if ticks is None:
            raise UnknownDemandError(f"there are ticks without a value for {core}")
        return self._time(ticks, self.settings.scale, core)

    def _call(self, call: Call, core: str, above: tuple[str, ...]) -> Sequence[Part]:
        runnable = self.system.runnables.get(call.runnable)
        if runnable is None:
            raise UnknownDemandError(f"the runnable {call.runnable!r} is not part of the model")
        if runnable.name in above:
            raise UnknownDemandError(f"the runnable {runnable.name!r} calls itself")
        parts = self._runnable(runnable, core, above)
        match runnable.condition and holds(runnable.condition, self.settings.modes):
            case False:
                return []
            case None if runnable.condition is not None:
                parts = [replace(_any_time(part), best=0) for part in parts]
        if call.times is not None:
            parts = [_repeated(part, call.times) for part in parts]
        return [_counted(part, call.counter) for part in parts] if call.counter else parts

    def _runnable(self, runnable: Runnable, core: str, above: tuple[str, ...]) -> Sequence[Part]:
        """The parts of a runnable; counters within it are not known to fall on certain jobs."""
        key = (runnable.name, core)
        if key not in self._known:
            inner = self._parts(runnable.activities, core, (*above, runnable.name))
            self._known[key] = _summed([_any_time(part) for part in inner])
        return self._known[key]

    def _time(self, ticks: Distribution[int], factor: Fraction, core: str) -> Part:
        """The grains that ticks take, or units of something that takes `factor` ticks each."""
        frequency = self.frequency(core)
        if frequency is None:
            raise UnknownDemandError(f"the clock of the core {core!r} is not known")
        worst, best = highest(ticks), lowest(ticks)
        if worst is None or best is None:
            raise UnknownDemandError("there is a distribution of ticks without bounds")
        tick = time_of_ticks(1, frequency) * factor * self.grains(core)
        if worst * tick > LIMIT:
            raise UnknownDemandError("there is an execution time beyond 13 days")
        # No time runs backwards, and none is longer than the longest, whatever a file says.
        longest = max(0, ceil(worst * tick))
        return Part(worst=longest, best=min(max(0, floor(best * tick)), longest), average=max(Fraction(0), mean(ticks) * tick))

    def _ticks_per_unit(self, need: str, core: str) -> Fraction:
        """What a unit of an execution need takes: the value of the feature, or its inverse for instructions per cycle."""
        kind = next((t for t in self.system.hardware.core_types if t.name == self.system.cores[core].type), None)
        for feature in kind.features if kind else ():
            if feature.category == need and feature.value:
                is_rate = feature.name.startswith("IPC")
                return 1 / Fraction(feature.value) if is_rate else Fraction(feature.value)
        if need == "Instructions":
            self.notes.assume("one instruction takes one tick where a core type does not say otherwise")
            return Fraction(1)
        raise UnknownDemandError(f"the type of {core} does not say what a unit of {need!r} costs")


def _summed(parts: Sequence[Part]) -> tuple[Part, ...]:
    """Parts of the same jobs taken together."""
    found: dict[tuple[int, int], Part] = {}
    for part in parts:
        key = (part.prescaler, part.offset)
        same = found.get(key)
        found[key] = (
            part
            if same is None
            else replace(same, worst=same.worst + part.worst, best=same.best + part.best, average=same.average + part.average)
        )
    return tuple(found.values())


def _scaled(parts: tuple[Part, ...], factor: Fraction | None) -> tuple[Part, ...]:
    """Parts that take longer or shorter by a factor."""
    if factor is None:
        return parts
    return tuple(
        replace(part, worst=ceil(part.worst * factor), best=floor(part.best * factor), average=part.average * factor)
        for part in parts
    )


def _counted(part: Part, counter: Counter) -> Part:
    """A part that is executed whenever a counter lets it through."""
    return replace(part, prescaler=counter.prescaler, offset=counter.offset)


def _any_time(part: Part) -> Part:
    """A part of which it is not known in which jobs it falls: it may in each, and may not in each."""
    if part.prescaler == 1 and part.offset <= 1:
        return part
    return Part(worst=part.worst, best=0, average=part.average / part.prescaler)


def _repeated(part: Part, times: Count | float) -> Part:
    """A part that is executed several times."""
    least, average, most = (times.least, times.mean, times.most) if isinstance(times, Count) else (times, times, times)
    return replace(part, worst=part.worst * ceil(most), best=part.best * floor(least), average=part.average * Fraction(average))


def _one_of(alternatives: Sequence[Sequence[Part]], weights: Sequence[float]) -> Sequence[Part]:
    """The part that stands for any of some alternatives."""
    plain = [[_any_time(part) for part in parts] for parts in alternatives]
    worst = [sum(part.worst for part in parts) for parts in plain]
    best = [sum(part.best for part in parts) for parts in plain]
    average = [sum((part.average for part in parts), Fraction(0)) for parts in plain]
    total = sum(map(Fraction, weights))
    if not worst:
        return []
    if not total:
        weights, total = [1.0] * len(worst), Fraction(len(worst))
    weighted = sum((value * Fraction(weight) for value, weight in zip(average, weights, strict=True)), Fraction(0))
    return [Part(worst=max(worst), best=min(best), average=weighted / total)]
