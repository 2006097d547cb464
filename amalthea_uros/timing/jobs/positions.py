"""The activities of a process in the order in which a job reaches them: the one walk through activity graphs and calls."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple, TypeAlias

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import (
    WITH_PARTS,
    Activity,
    Call,
    Count,
    Group,
    LabelAccess,
    Loop,
    ProbabilitySwitch,
    Switch,
    Terminate,
    inner_activities,
)
from amalthea_uros.perf.conditions import Condition, holds
from amalthea_uros.perf.software import Process, Runnable
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.perf.system import System
from amalthea_uros.timing.jobs.counters import ALWAYS, CallSites, reached
from amalthea_uros.timing.jobs.executed import MAX_CALL_DEPTH, bounds_of

#: Processes with more activities are not analysed.
MAX_POSITIONS = 200_000

#: Most activities are accesses: what only these classes need is not looked for in the others.
_WITH_CONDITIONS = (Call, Loop, Switch)

#: Lists of activities, from the process inwards, each with an index into it.
Nesting: TypeAlias = tuple[tuple[tuple[Activity, ...], int], ...]


class ActivityPosition(NamedTuple):
    """An activity in the jobs of a process.

    Attributes
    ----------
    number : order in which a job reaches it
    last : the number of the last activity within it, its own if there is none
    runnable : that contains it; None: directly in the process
    outer : the lists of activities that contain it
    counter : in which jobs it is reached, apart from branches; None if unknown, because other processes or branches count, too
    is_certain : whether each job reaches it at the same point, apart from the counter
    times : how often a job executes it at most; None if that is unknown
    conditions : those that are tested when a job reaches it
    """

    process: Process
    number: int
    last: int
    activity: Activity
    runnable: str | None
    outer: Nesting
    counter: Counter | None
    is_certain: bool
    times: int | None
    conditions: tuple[Condition, ...] = ()


def is_in_fixed_order(position: ActivityPosition) -> bool:
    """Whether no group around an activity executes its parts in any order."""
    around = (activities[index] for activities, index in position.outer[:-1])
    return all(each.ordered for each in around if isinstance(each, Group))


def positions(process: Process, system: System, sites: CallSites) -> list[ActivityPosition]:
    """All activities of the jobs of a process, in order; a call is followed by the activities of its runnable.

    Parameters
    ----------
    sites : the calls of the system

    Raises
    ------
    UnknownError : it has more than `MAX_POSITIONS` activities, or calls nested deeper than `MAX_CALL_DEPTH`.
    """
    if reached(process.activities, sites.sizes) > MAX_POSITIONS:
        raise _too_complex(process)
    walk = _Walk(process, system, sites)
    walk.through(process.activities, _Branch())
    return [position for position in walk.found if position is not None]


def ends_early(position: ActivityPosition) -> bool:
    """Whether a job ends at a position that others can follow."""
    return isinstance(position.activity, Terminate) and any(index + 1 < len(part) for part, index in position.outer)


@dataclass(frozen=True, slots=True)
class _Branch:
    """The common properties of all activities of a list."""

    runnable: str | None = None
    outer: Nesting = ()
    counter: Counter | None = ALWAYS
    is_certain: bool = True
    times: int | None = 1
    above: tuple[str, ...] = ()
    calls: tuple[Call, ...] = ()


@dataclass(slots=True)
class _Walk:
    process: Process
    system: System
    sites: CallSites
    found: list[ActivityPosition | None] = field(default_factory=list)

    def through(self, activities: tuple[Activity, ...], branch: _Branch) -> None:
        for index, activity in enumerate(activities):
            outer = (*branch.outer, (activities, index))
            counter, times = branch.counter, branch.times
            place = len(self.found)
            if place >= MAX_POSITIONS or len(branch.above) > MAX_CALL_DEPTH:
                raise _too_complex(self.process)
            if isinstance(activity, LabelAccess):
                self.found.append(self._access(activity, branch, outer))
                continue
            if isinstance(activity, Call):
                times = _repeated(times, activity.times)
                counter = self._counter((*branch.calls, activity), branch)
            # Its last number is known only after its inner activities.
            self.found.append(None)
            if isinstance(activity, Call):
                called = self.system.runnables.get(activity.runnable)
                if called is not None and called.name not in branch.above:
                    self.through(called.activities, _of_call(activity, called, branch, outer, counter, times))
            elif isinstance(activity, WITH_PARTS):
                is_certain = branch.is_certain and isinstance(activity, Group) and activity.ordered
                within = _Branch(branch.runnable, outer, counter, is_certain, times, branch.above, branch.calls)
                for each in inner_activities(activity):
                    self.through(each, within)
            self.found[place] = ActivityPosition(
                self.process,
                place + 1,
                len(self.found),
                activity,
                branch.runnable,
                outer,
                counter,
                branch.is_certain,
                times,
                _conditions(activity, self.system) if isinstance(activity, _WITH_CONDITIONS) else (),
            )

    def _access(self, access: LabelAccess, branch: _Branch, outer: Nesting) -> ActivityPosition:
        """The position of an access, as most activities are: nothing is within it."""
        number, times = len(self.found) + 1, _repeated(branch.times, access.times)
        certain = branch.is_certain
        return ActivityPosition(self.process, number, number, access, branch.runnable, outer, branch.counter, certain, times)

    def _counter(self, calls: tuple[Call, ...], branch: _Branch) -> Counter | None:
        """In which jobs the last of nested calls is executed; None if unknown."""
        if calls[-1].counter is None:
            return branch.counter
        counter: Counter = ALWAYS
        for call in reversed(calls):
            try:
                found = self.sites.lifted(call, counter)
            except UnknownError:
                return None
            if found is None:
                return None
            counter = found
        return counter


def _too_complex(process: Process) -> UnknownError:
    return UnknownError(f"{process.name!r} has too many calls, or too deeply nested calls, to be analysed")


def _of_call(
    call: Call, called: Runnable, branch: _Branch, outer: Nesting, counter: Counter | None, times: int | None
) -> _Branch:
    is_certain = branch.is_certain and call.times is None and called.condition is None
    return _Branch(called.name, outer, counter, is_certain, times, (*branch.above, called.name), (*branch.calls, call))


def _conditions(activity: Activity, system: System) -> tuple[Condition, ...]:
    match activity:
        case Call(runnable=name):
            found = [system.runnables[name].condition] if name in system.runnables else []
        case Loop(condition=condition):
            found = [condition]
        case Switch(cases=cases):
            found = [case.condition for case in cases]
        case _:
            return ()
    return tuple(condition for condition in found if condition is not None)


def _repeated(outer: int | None, times: Count | float | None) -> int | None:
    """The maximum number of executions of an activity within others; None if it is unknown."""
    _, most = bounds_of(times)
    return None if outer is None or most is None else outer * most


def can_be_skipped(position: ActivityPosition, system: System, modes: Mapping[str, str]) -> bool:
    """Whether a job that a counter lets reach a position may still not reach it.

    Parameters
    ----------
    modes : the known values of mode labels
    """
    *around, (activities, index) = position.outer
    containers = [within[number] for within, number in around]
    return any(isinstance(each, Switch | ProbabilitySwitch | Loop) for each in containers) or any(
        _need_not_occur(each, system, modes) for each in (*containers, activities[index])
    )


def _need_not_occur(activity: Activity, system: System, modes: Mapping[str, str]) -> bool:
    if not isinstance(activity, Call | LabelAccess):
        return False
    least, _ = bounds_of(activity.times)
    if least < 1 or isinstance(activity, LabelAccess):
        return least < 1
    called = system.runnables.get(activity.runnable)
    return called is not None and called.condition is not None and not holds(called.condition, modes)
