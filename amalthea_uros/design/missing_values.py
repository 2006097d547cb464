"""Values that a model leaves open and changes can state, so that more processes have a bounded response time.

Which values a system needs is found by trying: what is proposed was applied and analysed. The values are examples, as only who knows
the system can state them; so nothing of the results is kept but how many processes have one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import count

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.changes.apply import apply
from amalthea_uros.design.changes.change import Change
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.activities import Call, Execute, walk
from amalthea_uros.perf.distributions import highest, lowest
from amalthea_uros.perf.os import Policy
from amalthea_uros.perf.software import Task
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.timing.event_models.stimuli import is_unbounded
from amalthea_uros.timing.jobs.executed import executed
from amalthea_uros.timing.scheduling.allocation import scheduler_cores
from amalthea_uros.timing.scheduling.scheduled import EqualPriority

#: Examples: a value that is accepted, and which nobody takes for that of his system.
_PERIOD, _DEADLINE, _FREQUENCY, _EXECUTION_TIME = "1s", "1s", "100MHz", "1000ticks"
#: One statement can show that another one is needed: an allocated task needs a priority.
_ROUNDS = 4
#: Analyses of so many processes in all are tried, so that the proposal takes no longer than the analysis of a large model.
_EFFORT = 100


@dataclass(frozen=True, slots=True)
class MissingValues:
    """Statements with which more is known.

    Attributes
    ----------
    given : changes that were made already
    changes : with values that are examples
    gained : processes that have a bounded response time with them, and none without
    lacks_schedulers : whether no scheduler is responsible for a core, which no change can state
    """

    given: tuple[Change, ...]
    changes: tuple[Change, ...]
    gained: tuple[str, ...]
    lacks_schedulers: bool = False


def missing_values(
    system: System, settings: Settings, analysis: Analysis, given: tuple[Change, ...] = ()
) -> MissingValues | None:
    """The fewest statements that give the most results; None if no process lacks one, or no statement helps.

    Parameters
    ----------
    analysis : of the system with the settings
    given : changes that were made already
    """
    if analysis.processes and not any(scheduler_cores(name, system) for name in system.schedulers):
        return MissingValues(given, (), (), lacks_schedulers=True)
    trial = _ValueTrial(system, settings, _bounded(analysis))
    if len(trial.before) == len(analysis.processes) or len(analysis.processes) > _EFFORT:
        return None
    changes: list[Change] = []
    current = analysis
    for _ in range(_ROUNDS):
        changed, new = trial.accepted(changes, _wanted(current))
        if not new or not trial.may_continue():
            break
        changes += new
        current = analyze_system(changed, _settings(system, settings, changes))
        trial.note(changes, current)
    changes = trial.shortened(changes)
    gained = trial.gained(changes)
    return MissingValues(given, tuple(changes), tuple(gained)) if gained else None


def _settings(system: System, settings: Settings, changes: Sequence[Change]) -> Settings:
    return apply(system, settings, changes).settings


def _bounded(analysis: Analysis) -> set[str]:
    return {each.name for each in analysis.processes if each.response is not None and each.response.worst is not None}


@dataclass(slots=True)
class _ValueTrial:
    """Analyses with statements, up to an effort.

    Attributes
    ----------
    before : the processes that have a bound without any
    """

    system: System
    settings: Settings
    before: set[str]
    effort: int = 0
    _gained: dict[tuple[Change, ...], list[str]] = field(default_factory=dict)

    def may_continue(self) -> bool:
        """Whether another analysis is within the effort; counts it."""
        self.effort += max(1, len(self.system.processes))
        return self.effort <= _EFFORT

    def accepted(self, changes: Sequence[Change], wanted: Iterator[Change]) -> tuple[System, list[Change]]:
        """Those of the wanted changes that are possible and not made yet, and the system with them."""
        made = {change.target for change in changes}
        configuration = apply(self.system, self.settings, changes)
        new: list[Change] = []
        for change in wanted:
            if change.target in made or not str(change).isprintable():
                continue
            try:
                configuration = apply(*configuration, [change])
            except InvalidArgumentError:
                continue
            made.add(change.target)
            new.append(change)
        return configuration.system, new

    def gained(self, changes: Sequence[Change]) -> list[str]:
        """The processes that have a bound only with the changes."""
        if tuple(changes) not in self._gained:
            self.note(changes, analyze_system(*apply(self.system, self.settings, changes)))
        return self._gained[tuple(changes)]

    def note(self, changes: Sequence[Change], analysis: Analysis) -> None:
        """Remember what an analysis with changes gains."""
        bounded = _bounded(analysis)
        self._gained[tuple(changes)] = [name for name in self.system.processes if name in bounded and name not in self.before]

    def shortened(self, changes: Sequence[Change]) -> list[Change]:
        """The changes without those that give no result."""
        kept, most = list(changes), len(self.gained(changes)) if changes else 0
        for change in reversed(changes):
            others = [each for each in kept if each != change]
            if not self.may_continue():
                break
            try:
                if len(self.gained(others)) >= most:
                    kept = others
            except InvalidArgumentError:
                continue  # another one needs it
        return kept


def _wanted(analysis: Analysis) -> Iterator[Change]:
    """The values that the processes without a bound, and those beside them, do not state."""
    bounded = _bounded(analysis)
    context = analysis.solution.context
    yield from _clocks(context.system, context.settings)
    for name, scheduler in context.system.schedulers.items():
        if scheduler.policy is None:
            yield Change(name, "policy", str(Policy.FIXED_PRIORITY_PREEMPTIVE))
    yield from _priorities(analysis)
    for name, process in context.system.processes.items():
        if name in bounded:
            continue
        if isinstance(process, Task) and name not in context.scheduled:
            yield from _allocation(name, context.system)
        if not process.stimuli:
            yield Change(name, "period", _PERIOD)
        for stimulus in (context.system.stimuli_by_name.get(each) for each in process.stimuli):
            if stimulus is not None and is_unbounded(stimulus, context.system):
                yield Change(stimulus.name, "min_distance", _PERIOD)
        if name not in context.scheduled or context.scheduled[name].deadline is None:
            yield Change(name, "deadline", _DEADLINE)
        yield from _execution_times(name, context.system)


def _clocks(system: System, settings: Settings) -> Iterator[Change]:
    """The frequencies of cores that are unknown."""
    for name, core in system.cores.items():
        if not settings.frequencies.get(name) and not system.frequency_of(core.clock):
            yield Change(name, "frequency", _FREQUENCY)


def _priorities(analysis: Analysis) -> Iterator[Change]:
    """Priorities that schedulers need, each another one and none that is used."""
    context = analysis.solution.context
    used = {allocation.priority for allocation in context.system.mapping.tasks}
    unused = (number for number in count(1) if number not in used)
    for allocation in context.system.mapping.tasks:
        scheduled = context.scheduled.get(allocation.task)
        is_needed = scheduled is None or scheduled.equal_priority is EqualPriority.UNKNOWN
        if allocation.priority is None and is_needed:
            yield Change(allocation.task, "priority", str(next(unused)))


def _allocation(task: str, system: System) -> Iterator[Change]:
    """The first scheduler that is responsible for a core, if nothing dispatches a task."""
    if any(allocation.task == task for allocation in system.mapping.tasks):
        return
    scheduler = next((name for name in system.schedulers if scheduler_cores(name, system)), None)
    if scheduler is not None:
        yield Change(task, "scheduler", scheduler)


def _execution_times(process: str, system: System) -> Iterator[Change]:
    """The execution times without bounds, of a process and what it calls."""
    activities = list(executed(system.processes[process].activities, system))
    for name in dict.fromkeys(each.runnable for each in activities if isinstance(each, Call)):
        if name in system.runnables and any(map(_is_unbounded, walk(system.runnables[name].activities))):
            yield Change(name, "execution_time", _EXECUTION_TIME)
    if any(map(_is_unbounded, walk(system.processes[process].activities))):
        yield Change(process, "execution_time", _EXECUTION_TIME)


def _is_unbounded(activity: object) -> bool:
    if not isinstance(activity, Execute) or activity.demand.ticks is None:
        return False
    return None in (lowest(activity.demand.ticks), highest(activity.demand.ticks))
