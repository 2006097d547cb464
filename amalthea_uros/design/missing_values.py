"""Values that a model leaves open and changes can state, so that more processes have a bounded response time.

Which values a system needs is found by trying: what is proposed was applied and analysed. The values are examples, as only who knows
the system can state them; so nothing of the results is kept but how many processes have one.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from itertools import count
from typing import TYPE_CHECKING

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.analyze.phases.cases import MAX_JOBS
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.changes.change import Change
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.activities import Call, Execute, walk
from amalthea_uros.perf.distributions import highest, lowest
from amalthea_uros.perf.os import Policy
from amalthea_uros.perf.software import Process, Task
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.activations import spare_stimulus
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.timing.dataflow.links import Dataflow
from amalthea_uros.timing.event_models.stimuli import is_unbounded
from amalthea_uros.timing.jobs.executed import executed, states_execution_time
from amalthea_uros.timing.scheduling.allocation import allocated_cores, is_without_meaning, scheduler_cores, standard_policy
from amalthea_uros.timing.scheduling.scheduled import EqualPriority

if TYPE_CHECKING:
    from amalthea_uros.design.changes.origin import SystemOrigin
    from amalthea_uros.design.description.origin import DescriptionOrigin

#: Examples: a value that is accepted, and which nobody takes for that of his system.
_PERIOD, _DEADLINE, _TIME_SLICE, _FREQUENCY, _EXECUTION_TIME = "1s", "1s", "1ms", "100MHz", "1000ticks"
#: For models without hardware: so that the tasks of a small one fit on it.
_CORE, _CORE_FREQUENCY = "CPU", "1GHz"
#: What a process needs in any case if the changes give it a response time: nothing dispatched or activated it without them.
_INDISPENSABLE = ("core", "scheduler", "period", "stimulus")
#: One statement can show that another one is needed: an allocated task needs a priority.
_ROUNDS = 4
#: Analyses of so many processes in all are tried, so that the proposal takes no longer than the analysis of a large model.
_EFFORT = 200


@dataclass(frozen=True, slots=True)
class MissingValues:
    """Statements with which more is known.

    Attributes
    ----------
    given : changes that were made already
    changes : with values that are examples
    gained : processes that have a bounded response time with them, and none without
    lacks_schedulers : whether no scheduler is responsible for a core; other files of the model may have them
    """

    given: tuple[Change, ...]
    changes: tuple[Change, ...]
    gained: tuple[str, ...]
    lacks_schedulers: bool = False


def lacks_values(system: System, analysis: Analysis) -> bool:
    """Whether a process has no bounded response time, or no scheduler is responsible for a core."""
    return len(_bounded(analysis)) < len(analysis.processes) or _lacks_schedulers(system, analysis)


def missing_values(
    origin: DescriptionOrigin | SystemOrigin, analysis: Analysis, given: tuple[Change, ...] = (), unset: Sequence[Change] = ()
) -> MissingValues | None:
    """The fewest statements that give the most results; None if no process lacks one, or no statement helps.

    Parameters
    ----------
    origin : of the system that was analysed
    given : changes that were made already
    unset : examples of values that its description does not have
    """
    system = origin.present.system
    lacks_schedulers = _lacks_schedulers(system, analysis)
    trial = _ValueTrial(origin, _bounded(analysis), len(system.processes))
    nothing = MissingValues(given, (), (), lacks_schedulers=True) if lacks_schedulers else None
    if len(trial.before) == len(analysis.processes) or len(analysis.processes) > _EFFORT:
        return nothing
    # Where nothing is gained with priorities above those that are stated, something may be with others below them.
    stated = [each.priority for each in system.mapping.tasks if each.priority is not None]
    for first_priority in (1, min(stated, default=0) - (len(system.mapping.tasks) - len(stated))):
        changes = trial.shortened(trial.stated(analysis, unset, first_priority))
        if gained := trial.gained(changes):
            return MissingValues(given, tuple(changes), tuple(gained), lacks_schedulers)
    return nothing


def _lacks_schedulers(system: System, analysis: Analysis) -> bool:
    return bool(analysis.processes) and not _dispatching(system)


def _dispatching(system: System) -> list[str]:
    """The schedulers that are responsible for a core."""
    return [name for name in system.schedulers if scheduler_cores(name, system)]


def _bounded(analysis: Analysis) -> set[str]:
    return {each.name for each in analysis.processes if each.response is not None and each.response.worst is not None}


def _possible(origin: DescriptionOrigin | SystemOrigin, changes: Sequence[Change]) -> list[Change]:
    """Changes without those that are not possible after the ones before them; some errors only show when the whole is built."""
    try:
        origin.configure(changes)
    except InvalidArgumentError:
        if len(changes) < 2:
            return []
        middle = len(changes) // 2
        before = _possible(origin, changes[:middle])
        return [*before, *_possible(origin.after(before), changes[middle:])]
    return list(changes)


@dataclass(slots=True)
class _ValueTrial:
    """Analyses with statements, up to an effort and a work.

    Attributes
    ----------
    before : the processes that have a bound without any
    size : the number of processes
    work : of the analyses, in jobs
    """

    origin: DescriptionOrigin | SystemOrigin
    before: set[str]
    size: int
    effort: int = 0
    work: int = 0
    _gained: dict[tuple[Change, ...], list[str]] = field(default_factory=dict)

    def may_continue(self) -> bool:
        """Whether another analysis is within the effort, which it counts, and the work of those before is not too much."""
        self.effort += max(1, self.size)
        return self.effort <= _EFFORT and self.work < MAX_JOBS

    def stated(self, current: Analysis, unset: Sequence[Change], first_priority: int) -> list[Change]:
        """All values that processes without a bound lack, and what these lack once they are stated."""
        changes: list[Change] = []
        for _ in range(_ROUNDS):
            new = self.accepted(changes, (*unset, *_wanted(current, first_priority)))
            if not new or not self.may_continue():
                break
            changes += new
            current = analyze_system(*self.origin.configure(changes))
            self.note(changes, current)
        return changes

    def accepted(self, changes: Sequence[Change], wanted: Iterable[Change]) -> list[Change]:
        """Those of the wanted changes that are possible and not made yet."""
        made = {change.target for change in changes}
        pending = [each for each in wanted if each.target not in made and str(each).isprintable()]
        new: list[Change] = []
        while pending:
            # Of a target, another value is tried where the first one is not possible.
            first = {each.target: each for each in reversed(pending)}
            new += _possible(self.origin.after([*changes, *new]), [each for each in pending if first[each.target] is each])
            made |= {each.target for each in new}
            pending = [each for each in pending if each.target not in made and first[each.target] is not each]
        return new

    def gained(self, changes: Sequence[Change]) -> list[str]:
        """The processes that have a bound only with the changes."""
        if tuple(changes) not in self._gained:
            self.note(changes, analyze_system(*self.origin.configure(changes)))
        return self._gained[tuple(changes)]

    def note(self, changes: Sequence[Change], analysis: Analysis) -> None:
        """Remember what an analysis with changes gains."""
        self.work += analysis.work
        bounded = _bounded(analysis)
        names = self.origin.present.system.processes
        self._gained[tuple(changes)] = [name for name in names if name in bounded and name not in self.before]

    def shortened(self, changes: Sequence[Change]) -> list[Change]:
        """The changes without those that give no result."""
        kept = list(changes)
        gained = self.gained(changes) if changes else []
        for part in _parts(changes, gained):
            others = [each for each in kept if each not in part]
            if others == kept:
                continue
            if not self.may_continue():
                break
            try:
                if len(self.gained(others)) >= len(gained):
                    kept = others
            except InvalidArgumentError:
                continue  # another one needs it
        return kept


def _parts(changes: Sequence[Change], gained: Sequence[str]) -> Iterator[list[Change]]:
    """The changes that may be needless: all of a process without a result, then all of one kind, and then each one."""
    needless = [each for each in changes if each.object not in gained or each.key not in _INDISPENSABLE]
    for name in dict.fromkeys(each.object for each in needless if each.object not in gained):
        yield [each for each in needless if each.object == name]
    for key in dict.fromkeys(each.key for each in reversed(needless)):
        yield [each for each in needless if each.key == key]
    yield from ([each] for each in reversed(needless))


def _wanted(analysis: Analysis, first_priority: int) -> Iterator[Change]:
    """The values that the processes without a bound, and those beside them, do not state."""
    bounded = _bounded(analysis)
    context = analysis.solution.context
    yield from _clocks(context.system, context.settings)
    lone = None if _dispatching(context.system) else next(iter(context.system.cores), _CORE)
    if lone is not None:
        yield Change(lone, "policy", str(Policy.FIXED_PRIORITY_PREEMPTIVE))
    for name, scheduler in context.system.schedulers.items():
        if scheduler.policy is None or is_without_meaning(scheduler.policy):
            yield Change(name, "policy", str(Policy.FIXED_PRIORITY_PREEMPTIVE))
        if standard_policy(scheduler.policy) == Policy.PRIORITY_BASED_ROUND_ROBIN:
            yield Change(name, "time_slice", _TIME_SLICE)
    yield from _priorities(analysis, first_priority)
    for name, process in context.system.processes.items():
        if name in bounded:
            continue
        if name not in context.scheduled:
            yield from _allocation(process, context.system, lone)
        if not process.stimuli:
            yield _activation(name, context.dataflow)
        for stimulus in (context.system.stimuli_by_name.get(each) for each in process.stimuli):
            if stimulus is not None and is_unbounded(stimulus, context.system):
                yield Change(stimulus.name, "min_distance", _PERIOD)
        if name in context.scheduled and context.scheduled[name].deadline is None:
            yield Change(name, "deadline", _DEADLINE)
        yield from _execution_times(name, context.system)


def _clocks(system: System, settings: Settings) -> Iterator[Change]:
    """The frequencies of cores that are unknown, or a core where there is none."""
    if not system.cores:
        yield Change(_CORE, "frequency", _CORE_FREQUENCY)
    for name, core in system.cores.items():
        if not settings.frequencies.get(name) and not system.frequency_of(core.clock):
            yield Change(name, "frequency", _FREQUENCY)


def _priorities(analysis: Analysis, first: int) -> Iterator[Change]:
    """Priorities that schedulers need, each another one and none that is used; rate-monotonic, which misses the least."""
    context = analysis.solution.context
    used = {allocation.priority for allocation in context.system.mapping.tasks}
    unused = (number for number in count(first) if number not in used)
    for allocation in sorted(context.system.mapping.tasks, key=lambda each: _rate(analysis, each.task)):
        scheduled = context.scheduled.get(allocation.task)
        is_needed = scheduled is None or scheduled.equal_priority is EqualPriority.UNKNOWN
        if allocation.priority is None and is_needed:
            yield Change(allocation.task, "priority", str(next(unused)))


def _rate(analysis: Analysis, task: str) -> Fraction:
    """How often a task is activated at most; 0 if that is unknown."""
    distance = analysis[task].min_interarrival
    return Fraction(1, distance) if distance else Fraction(0)


def _activation(process: str, dataflow: Dataflow) -> Change:
    """The stimulus with the name of a process that has none, or a period."""
    spare = spare_stimulus(process, dataflow)
    if spare is not None and process in spare.name and not spare.is_triggered:
        return Change(process, "stimulus", spare.name)
    return Change(process, "period", _PERIOD)


def _allocation(process: Process, system: System, core: str | None) -> Iterator[Change]:
    """A scheduler that is responsible for a core, in turn, or else the scheduler of a core, if nothing dispatches a process on one."""
    name, placed = process.name, allocated_cores(system)
    if name in placed:
        return
    if core is not None or not isinstance(process, Task):
        yield Change(name, "core", core or next(iter(system.cores)))
    else:
        schedulers, waiting = _dispatching(system), [each for each in system.processes if each not in placed]
        yield Change(name, "scheduler", schedulers[waiting.index(name) % len(schedulers)])


def _execution_times(process: str, system: System) -> Iterator[Change]:
    """The execution times without bounds, of a process and what it calls; if it has none, one of these."""
    activities = list(executed(system.processes[process].activities, system))
    called = list(dict.fromkeys(each.runnable for each in activities if isinstance(each, Call)))
    for name in called:
        if name in system.runnables and any(map(_is_unbounded, walk(system.runnables[name].activities))):
            yield Change(name, "execution_time", _EXECUTION_TIME)
    if any(map(_is_unbounded, walk(system.processes[process].activities))):
        yield Change(process, "execution_time", _EXECUTION_TIME)
    if not states_execution_time(system.processes[process], system):
        yield Change((*called, process)[0], "execution_time", _EXECUTION_TIME)


def _is_unbounded(activity: object) -> bool:
    if not isinstance(activity, Execute) or activity.demand.ticks is None:
        return False
    return None in (lowest(activity.demand.ticks), highest(activity.demand.ticks))
