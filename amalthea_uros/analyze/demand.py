"""The execution demand of processes: their activity graphs walked, ticks turned into time on a core.

A tick is often no whole number of picoseconds. So that nothing is rounded before the end, the demand on a core is counted in grains:
the greatest parts of a picosecond of which a tick is a whole number (a third of one at 300 MHz). Of branches the worst one counts in
the worst case and the best one in the best case; a call that is executed every n-th time only stays a part of its own, so that a job
without it does not pay for it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from math import ceil, floor

from amalthea_uros.analyze.cost import Cost, Part
from amalthea_uros.analyze.means import mean
from amalthea_uros.analyze.notes import Notes
from amalthea_uros.perf.distributions import Distribution, highest, lowest
from amalthea_uros.perf.software import (
    Activity,
    Call,
    Count,
    Execute,
    ExecutionNeed,
    Group,
    Loop,
    ProbabilitySwitch,
    Process,
    Runnable,
    Switch,
)
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.perf.system import System
from amalthea_uros.units import Frequency, time_of_ticks

#: Finer grains would bring times near to the limits of whole numbers of 64 bits.
MOST_GRAINS = 1000


class UnknownDemandError(Exception):
    """The demand of a process is not known; the text says why."""


@dataclass(slots=True)
class Demands:
    """The demand of the processes of a system.

    Attributes
    ----------
    frequencies : of cores, instead of what the system says
    scale : factor on all execution times
    """

    system: System
    notes: Notes
    frequencies: dict[str, Frequency] = field(default_factory=dict)
    scale: Fraction = Fraction(1)
    _known: dict[tuple[str, str], tuple[Part, ...]] = field(default_factory=dict)

    def grains(self, core: str) -> int:
        """How many grains a picosecond has on a core; 1 where they would be too small, and then demand is rounded outwards."""
        frequency = self.frequency(core)
        if frequency is None:
            return 1
        fineness = (time_of_ticks(1, frequency) * self.scale).denominator
        return fineness if fineness <= MOST_GRAINS else 1

    def frequency(self, core: str) -> Frequency | None:
        """The clock of a core, None if it is not known."""
        if core in self.frequencies:
            return self.frequencies[core]
        clock = self.system.clocks.get(self.system.cores[core].clock or "")
        return clock.frequency if clock is not None and clock.frequency else None

    def cost(self, process: Process, core: str) -> Cost:
        """What the jobs of a process cost on a core, in its grains.

        Raises
        ------
        UnknownDemandError : something in it has no bound, or the core no clock.
        """
        return Cost(_summed(self._parts(process.activities, core, ())))

    def _parts(self, activities: Iterable[Activity], core: str, above: tuple[str, ...]) -> list[Part]:
        return [part for activity in activities for part in self._of(activity, core, above)]

    def _of(self, activity: Activity, core: str, above: tuple[str, ...]) -> Sequence[Part]:
        """The parts of one activity; what takes no time has none."""
        match activity:
            case Execute(demand=demand):
                by_type = dict(demand.by_core_type)
                ticks = by_type.get(self.system.cores[core].type or "", demand.ticks)
                if ticks is None:
                    raise UnknownDemandError(f"there are ticks without a value for {core}")
                return [self._time(ticks, self.scale, core)]
            case ExecutionNeed(needs=needs):
                return [self._time(need, self._ticks_per_unit(name, core) * self.scale, core) for name, need in needs]
            case Call():
                return self._call(activity, core, above)
            case Group(activities=inner):
                return self._parts(inner, core, above)
            case ProbabilitySwitch(branches=branches):
                weights = [branch.weight for branch in branches]
                return _one_of([self._parts(branch.activities, core, above) for branch in branches], weights)
            case Switch(cases=cases, default=default):
                alternatives = [*(case.activities for case in cases), default or ()]
                return _one_of([self._parts(inner, core, above) for inner in alternatives], [1.0] * len(alternatives))
            case Loop():
                raise UnknownDemandError("there is a loop, and nothing says how often it is repeated at most")
        return []

    def _call(self, call: Call, core: str, above: tuple[str, ...]) -> Sequence[Part]:
        runnable = self.system.runnables.get(call.runnable)
        if runnable is None:
            raise UnknownDemandError(f"the runnable {call.runnable!r} is not part of the model")
        if runnable.name in above:
            raise UnknownDemandError(f"the runnable {runnable.name!r} calls itself")
        parts = self._runnable(runnable, core, above)
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
        return Part(worst=ceil(worst * tick), best=floor(best * tick), average=mean(ticks) * tick)

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
