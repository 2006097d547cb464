"""Execution demand of processes: the sum over their activity graphs, with ticks converted to time on a core.

A tick is often not a whole number of picoseconds. To avoid rounding before the end, demand on a core is counted in its time base: the
largest fraction of a picosecond of which a tick is a multiple (a third of a picosecond at 300 MHz). Of several branches, the longest
counts in the worst case and the shortest in the best case. A call that is executed only every n-th time is a separate frame, so that
it does not increase the demand of jobs without it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from fractions import Fraction
from math import ceil, floor, inf

from amalthea_uros._internal.graphs import bottom_up
from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import (
    AccessKind,
    Activity,
    Call,
    Count,
    Demand,
    Execute,
    ExecutionNeed,
    Group,
    Incomplete,
    LabelAccess,
    Loop,
    Migrate,
    ModeAccess,
    ProbabilitySwitch,
    Receive,
    Send,
    SenderReceiverAccess,
    ServerCall,
    Switch,
    Terminate,
    WaitEvent,
    called_runnables,
)
from amalthea_uros.perf.conditions import holds
from amalthea_uros.perf.distributions import Distribution, highest, lowest
from amalthea_uros.perf.software import Isr, Process, Runnable
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.notes import AnalysisNotes
from amalthea_uros.timing.basics.settings import MemoryModel, Settings
from amalthea_uros.timing.basics.time_base import LIMIT, Ticks
from amalthea_uros.timing.demand.means import mean
from amalthea_uros.timing.demand.memory import MemoryAccess
from amalthea_uros.timing.demand.multiframe import (
    DemandFrame,
    MultiframeDemand,
    any_time,
    at_most,
    one_of,
    repeated,
    scaled,
    summed,
)
from amalthea_uros.timing.demand.overheads import Overheads
from amalthea_uros.timing.jobs.counters import CallSites, CounterFlaws, first_effect, is_always
from amalthea_uros.timing.jobs.executed import MAX_CALL_DEPTH, count_of, is_average, obstacle, servers, with_direct_calls
from amalthea_uros.timing.jobs.positions import ActivityPosition, ends_early, positions
from amalthea_uros.units import Frequency, time_of_ticks

#: With a finer time base, times could exceed 64-bit integers.
MAX_TIME_BASE = 1000


@dataclass(slots=True)
class DemandModel:
    """The demand of the processes of a system.

    Attributes
    ----------
    ignores_waits : whether demands are those without the time for which jobs wait for events; otherwise they are unknown
    """

    system: System
    notes: AnalysisNotes
    settings: Settings = field(default_factory=Settings)
    ignores_waits: bool = False
    memory: MemoryAccess = field(init=False)
    overheads: Overheads = field(init=False)
    sites: CallSites = field(init=False)
    flaws: CounterFlaws = field(init=False)
    _servers: Mapping[str, tuple[str, ...]] | None = None
    _time_bases: dict[str, int] = field(default_factory=dict)
    _times_of_ticks: dict[tuple[str, Fraction], int | Fraction] = field(default_factory=dict)
    _of_runnables: dict[tuple[str, str], tuple[DemandFrame, ...]] = field(default_factory=dict)
    _in_preparation: set[str] = field(default_factory=set)

    def __post_init__(self) -> None:
        self.system = with_direct_calls(self.system)
        self.memory = MemoryAccess(self.system, self.notes, self.frequency)
        self.overheads = Overheads(self.system)
        self.sites = CallSites(self.system)
        self.flaws = CounterFlaws(self.system)

    def keep(self, other: DemandModel) -> None:
        """Take over the model of a system whose processes differ in the offsets of counters, as far as these are irrelevant."""
        self.flaws, self._time_bases, self._times_of_ticks = other.flaws, other._time_bases, other._times_of_ticks
        self._of_runnables = other._of_runnables

    def time_base(self, core: str) -> int:
        """Time units per picosecond on a core; 1 if they would be too small, and then demand is rounded outwards."""
        if core not in self._time_bases:
            frequency = self.frequency(core)
            fineness = 1 if frequency is None else (time_of_ticks(1, frequency) * self.settings.scale).denominator
            self._time_bases[core] = fineness if fineness <= MAX_TIME_BASE else 1
        return self._time_bases[core]

    def frequency(self, core: str) -> Frequency | None:
        """The clock frequency of a core; None if it is unknown."""
        if core in self.settings.frequencies:
            return self.settings.frequencies[core]
        return self.system.frequency_of(self.system.cores[core].clock)

    def of_process(self, process: Process, core: str) -> MultiframeDemand:
        """Demand of the jobs of a process on a core, in its time base.

        Raises
        ------
        UnknownError : some demand is unbounded, or the frequency of the core is unknown.
        """
        if flaw := self.flaws.of_process(process):
            raise UnknownError(flaw)
        if Terminate in self.system.activity_classes and any(map(ends_early, self._positions(process))):
            raise UnknownError("it can terminate before its last activity, which cannot be analysed")
        frames = self._frames(process.activities, core, ())
        if self.settings.memory is MemoryModel.IMPLICIT:
            frames += [frame for _, frame in self.copies(process, core)]
        if isinstance(process, Isr):
            frames += [self._ticks(demand, core) for demand in self.overheads.of_isr(process, core) if demand is not None]
        return MultiframeDemand(scaled(summed(frames), self._growth(process)))

    def of_activities(self, process: Process, activities: Sequence[Activity], core: str) -> MultiframeDemand:
        """Demand of some activities of a process, without overheads of the process; raises as `of_process`."""
        return MultiframeDemand(scaled(summed(self._frames(activities, core, ())), self._growth(process)))

    def of_position(self, position: ActivityPosition, core: str, including: bool) -> MultiframeDemand:
        """Demand that jobs have executed when they reach a position, or have left it; raises as `of_process`."""
        frames: list[DemandFrame] = []
        for depth, (activities, index) in enumerate(position.outer, start=1):
            is_last = depth == len(position.outer)
            here = self._frames(activities[: index + (including and is_last)], core, ())
            for outer, at in reversed(position.outer[: depth - 1]):
                call = outer[at]
                if isinstance(call, Call):
                    here = [counted for frame in here if (counted := self._counted(frame, call)) is not None]
            frames += here
        return MultiframeDemand(scaled(summed(frames), self._growth(position.process)))

    def of_decision(self, overhead: Sequence[Activity], core: str) -> MultiframeDemand:
        """Demand of one decision of a scheduler with some overhead; raises as `of_process`."""
        # The decisions for all tasks count.
        frames = [any_time(frame) for frame in self._frames(overhead, core, ())]
        return MultiframeDemand(scaled(summed(frames), self.settings.growth))

    def _growth(self, process: Process) -> Fraction:
        """The factor on the worst-case execution times of a process."""
        return self.settings.growth * self.settings.factors.get(process.name, 1)

    def access(self, core: str, label: str, kind: AccessKind, times: Count | float | None) -> DemandFrame:
        """The demand of an access to a label, or to its copy, which can be anywhere on the way to the label; raises as `of_process`."""
        found = self.memory.frame(core, label, kind, count_of(times), self.settings.scale * self.time_base(core))
        return at_most(found) if self.settings.memory is MemoryModel.IMPLICIT else found

    def copies(self, process: Process, core: str) -> list[tuple[AccessKind, DemandFrame]]:
        """Copies of the labels that a process accesses, at its start (reads), and of those that it writes, at its end.

        Also a label that is only written is copied at the start, because a job need not write it, or all of it.
        """
        self.notes.assume("each label that a job accesses is copied at its start, and each one that it writes also at its end")
        self.notes.assume("an access to the copy of a label takes no longer than one to the label")
        certain: dict[tuple[str, AccessKind], bool] = {}
        for position in self._positions(process):
            if isinstance(position.activity, LabelAccess | SenderReceiverAccess):
                for kind in dict.fromkeys((AccessKind.READ, position.activity.kind)):
                    key = (position.activity.label, kind)
                    is_certain = position.is_certain and position.counter is not None and is_always(position.counter)
                    certain[key] = certain.get(key, False) or is_certain
        time_base = self.settings.scale * self.time_base(core)
        frames = [
            (key[1], self.memory.frame(core, *key, count_of(1), time_base), is_certain) for key, is_certain in certain.items()
        ]
        return [(kind, frame if is_certain else at_most(frame)) for kind, frame, is_certain in frames]

    def _positions(self, process: Process) -> Sequence[ActivityPosition]:
        """Everything that the jobs of a process do."""
        return positions(process, self.system, self.sites)

    def _frames(self, activities: Iterable[Activity], core: str, above: tuple[str, ...]) -> list[DemandFrame]:
        # Most activities are accesses.
        timeless = LabelAccess if self.settings.memory is MemoryModel.NONE else ()
        taking_time = (activity for activity in activities if not isinstance(activity, timeless))
        return [frame for activity in taking_time for frame in self._with_services(activity, core, above)]

    def _with_services(self, activity: Activity, core: str, above: tuple[str, ...]) -> Iterator[DemandFrame]:
        """The frames of one activity and of the OS services that it calls."""
        yield from self._of(activity, core, above)
        for demand in self.overheads.of_activity(activity, core):
            yield self._ticks(demand, core)

    def _of(self, activity: Activity, core: str, above: tuple[str, ...]) -> Sequence[DemandFrame]:
        """The frames of one activity; activities without execution time have none."""
        match activity:
            case Execute(demand=demand):
                return [self._ticks(demand, core)]
            case ExecutionNeed(needs=needs):
                scale = self.settings.scale
                return [self._time(need, self.ticks_per_unit(name, core) * scale, core) for name, need in needs]
            case LabelAccess(label=label, kind=kind, times=times) if self.settings.memory is not MemoryModel.NONE:
                self._require_maximum(times)
                return [self.access(core, label, kind, times)]
            case Send(channel=channel, elements=elements) if self.settings.memory is not MemoryModel.NONE:
                return [self.access(core, channel, AccessKind.WRITE, max(1, elements))]
            case Receive(channel=channel, elements=elements, at_least=least) if self.settings.memory is not MemoryModel.NONE:
                most = max(1, elements)
                return [self.access(core, channel, AccessKind.READ, Count(least=min(least, most), mean=most, most=most))]
            case ModeAccess() if self.settings.memory is not MemoryModel.NONE:
                self.notes.assume("accesses to mode labels take no time")
            case Call():
                return self._call(activity, core, above)
            case Group(activities=inner):
                return self._frames(inner, core, above)
            case ProbabilitySwitch(branches=branches):
                weights = [branch.weight for branch in branches]
                each_occurs = not any(weights) or all(weights)
                alternatives = [self._frames(branch.activities, core, above) for branch in branches]
                return one_of(alternatives, weights, each_occurs, is_chance=True)
            case Switch():
                alternatives = [self._frames(inner, core, above) for inner in self.possible_branches(activity)]
                # The modes can exclude branches, or combinations of them.
                return one_of(alternatives, [1.0] * len(alternatives), each_occurs=len(alternatives) == 1, is_chance=False)
            case Loop(condition=condition):
                if holds(condition, self.settings.modes) is False:
                    return []
                raise UnknownError("it contains a loop without an upper bound on the number of iterations")
            case ServerCall() | SenderReceiverAccess() if reason := self._obstacle(activity):
                raise UnknownError(reason)
            case SenderReceiverAccess(label=label, kind=kind) if self.settings.memory is not MemoryModel.NONE:
                return [self.access(core, label, kind, None)]
            case WaitEvent() if not self.ignores_waits:
                raise UnknownError("it waits for events without a timeout, so there is no upper bound")
            case Incomplete(reason=reason, is_access=is_access) if (
                not is_access or self.settings.memory is not MemoryModel.NONE
            ):
                raise UnknownError(f"it contains {reason}")
            case Migrate():
                raise UnknownError("it migrates to another scheduler, which cannot be analysed")
        return []

    def _obstacle(self, activity: ServerCall | SenderReceiverAccess) -> str:
        """Why the time that a server call or a notifying access takes is unknown."""
        if self._servers is None:
            self._servers = servers(self.system)
        return obstacle(activity, self._servers)

    def possible_branches(self, switch: Switch) -> list[tuple[Activity, ...]]:
        """The branches that can be taken, given the known modes."""
        found: list[tuple[Activity, ...]] = []
        for case in switch.cases:
            value = holds(case.condition, self.settings.modes)
            if value is not False:
                found.append(case.activities)
            if value:
                return found
        return [*found, switch.default or ()]

    def _ticks(self, demand: Demand, core: str) -> DemandFrame:
        return self._time(self.ticks(demand, core), self.settings.scale, core)

    def ticks(self, demand: Demand, core: str) -> Distribution[int]:
        """The ticks of a demand on a core; raises as `of_process`."""
        ticks = dict(demand.by_core_type).get(self.system.cores[core].type or "", demand.ticks)
        if ticks is None:
            raise UnknownError(f"ticks have no value for the core {core!r}")
        return ticks

    def _call(self, call: Call, core: str, above: tuple[str, ...]) -> Sequence[DemandFrame]:
        runnable = self.system.runnables.get(call.runnable)
        if runnable is None:
            raise UnknownError(f"the runnable {call.runnable!r} is not defined in the model")
        if runnable.name in above:
            raise UnknownError(f"the runnable {runnable.name!r} calls itself")
        if len(above) > MAX_CALL_DEPTH:
            raise UnknownError(f"calls are nested deeper than {MAX_CALL_DEPTH} levels")
        frames = self._runnable(runnable, core, above)
        match runnable.condition and holds(runnable.condition, self.settings.modes):
            case False:
                return []
            case None if runnable.condition is not None:
                frames = [
                    replace(any_time(frame), best=Ticks(0), is_certain=not frame.worst, least=Ticks(0)) for frame in frames
                ]
        if call.times is not None:
            self._require_maximum(call.times)
            frames = [repeated(frame, call.times) for frame in frames]
        return [counted for frame in frames if (counted := self._counted(frame, call)) is not None]

    def _require_maximum(self, times: Count | float | None) -> None:
        """Check that the maximum of a number of calls or accesses is known; raises as `of_process`."""
        if is_average(times):
            raise UnknownError(f"a number of calls or accesses, {times:g}, is an average without a maximum")
        if isinstance(times, float):
            self.notes.assume("a single whole number of calls or accesses is exact")

    def _runnable(self, runnable: Runnable, core: str, above: tuple[str, ...]) -> Sequence[DemandFrame]:
        """The frames of a runnable, by its own executions."""
        key = (runnable.name, core)
        if key not in self._of_runnables:
            self._prepare(runnable, core)
        if key not in self._of_runnables:
            inner = self._frames(runnable.activities, core, (*above, runnable.name))
            self._of_runnables[key] = summed(inner)
        return self._of_runnables[key]

    def _counted(self, frame: DemandFrame, call: Call) -> DemandFrame | None:
        """A frame of a called runnable in the executions of the caller; None if it is never executed."""
        if frame.is_always and call.counter is None:
            return DemandFrame(worst=frame.worst, best=frame.best, average=frame.average, offset=1, least=frame.least)
        inner = Counter(prescaler=frame.prescaler, offset=frame.offset, is_phase_known=frame.is_certain)
        try:
            counter = self.sites.lifted(call, inner)
        except UnknownError:
            prescaler = frame.prescaler * (call.counter.prescaler if call.counter else 1)
            return DemandFrame(
                worst=frame.worst, best=Ticks(0), average=frame.average / prescaler, is_certain=False, least=frame.least
            )
        if counter is None:
            return None
        is_certain = frame.is_certain and counter.is_phase_known
        return replace(
            frame,
            best=Ticks(0) if counter.jitter else frame.best,
            prescaler=counter.prescaler,
            offset=first_effect(counter),
            is_certain=is_certain,
            jitter=counter.jitter,
        )

    def _prepare(self, runnable: Runnable, core: str) -> None:
        """Find the frames of the called runnables first, innermost first, which avoids deep recursion."""
        if core in self._in_preparation:
            return
        self._in_preparation.add(core)
        for name in bottom_up([runnable.name], self._called)[:-1]:
            if (name, core) not in self._of_runnables:
                with suppress(UnknownError):
                    frames = self._frames(self.system.runnables[name].activities, core, (name,))
                    self._of_runnables[name, core] = summed(frames)
        self._in_preparation.remove(core)

    def _called(self, runnable: str) -> list[str]:
        """The runnables that a runnable calls directly."""
        called = called_runnables(self.system.runnables[runnable].activities)
        return [name for name in called if name in self.system.runnables]

    def _time(self, ticks: Distribution[int], factor: Fraction, core: str) -> DemandFrame:
        """The demand of ticks, or of units that take `factor` ticks each, in the time base."""
        tick = self.time_of_tick(factor, core)
        worst, best = highest(ticks), lowest(ticks)
        if worst is None or best is None:
            raise UnknownError("a distribution of ticks has no bounds; --quantile states how unlikely values are left out")
        # What an invalid value stands for is unknown.
        if best < 0:
            raise UnknownError("a number of ticks is negative")
        if best > worst:
            raise UnknownError("the minimum of a number of ticks is greater than the maximum")
        if worst * tick > LIMIT:
            raise UnknownError("an execution time exceeds 13 days")
        return DemandFrame(worst=Ticks(ceil(worst * tick)), best=Ticks(floor(best * tick)), average=mean(ticks) * tick)

    def time_of_tick(self, factor: Fraction, core: str) -> int | Fraction:
        """The time units that `factor` ticks of a core take: usually a whole number, with which it is quicker to calculate.

        Raises
        ------
        UnknownError : the frequency of the core is unknown.
        """
        key = (core, factor)
        if key not in self._times_of_ticks:
            frequency = self.frequency(core)
            if frequency is None:
                raise UnknownError(f"the clock frequency of the core {core!r} is unknown")
            found = time_of_ticks(1, frequency) * factor * self.time_base(core)
            self._times_of_ticks[key] = int(found) if found.denominator == 1 else found
        return self._times_of_ticks[key]

    def ticks_per_unit(self, need: str, core: str) -> Fraction:
        """Ticks per unit of an execution need: the value of the feature, or its inverse for instructions per cycle.

        Raises
        ------
        UnknownError : the type of the core does not define them.
        """
        kind = next((t for t in self.system.hardware.core_types if t.name == self.system.cores[core].type), None)
        for feature in kind.features if kind else ():
            if feature.category == need:
                if not 0 < feature.value < inf:
                    raise UnknownError(f"{feature.name!r} of the type of the core {core!r} is not positive and finite")
                is_rate = feature.name.startswith("IPC")
                return 1 / Fraction(feature.value) if is_rate else Fraction(feature.value)
        if need == "Instructions":
            self.notes.assume("an instruction takes one tick unless the core type specifies it")
            return Fraction(1)
        raise UnknownError(f"the type of the core {core!r} does not define the ticks for {need!r}")
