"""Counters: which occurrences take effect, and in which jobs that is.

Occurrence n takes effect if n >= max(offset, 1) and (n - offset) mod prescaler = 0. A counter belongs to its element of the model and
counts each time that the element is reached: a counted call inside a runnable counts the executions of the runnable by all callers.
What every n-th execution of a runnable executes is therefore in known jobs of a process only if the sequence of its calls is known.
With a prescaler below 1, a counter has no meaning: it is unknown which times take effect.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from math import gcd
from typing import TypeAlias

from amalthea_uros._internal.graphs import bottom_up
from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import (
    WITH_PARTS,
    Activity,
    Call,
    Group,
    SenderReceiverAccess,
    ServerCall,
    Trigger,
    called_runnables,
    inner_activities,
    walk,
)
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Counter, EventTriggered, InterProcess
from amalthea_uros.perf.system import System
from amalthea_uros.timing.jobs.executed import executed

#: The counter of what is executed every time.
ALWAYS = Counter(prescaler=1, offset=1)

#: A process or a runnable: whether it is a process, and its name.
_Caller: TypeAlias = tuple[bool, str]


def first_effect(counter: Counter) -> int:
    """Number of the first occurrence that takes effect, counted from 1."""
    return counter.offset if counter.offset >= 1 else (counter.offset - 1) % counter.prescaler + 1


def takes_effect(counter: Counter, number: int) -> bool:
    """Whether an occurrence takes effect, counted from 1."""
    first = first_effect(counter)
    return number >= first and (number - first) % counter.prescaler == 0


def is_always(counter: Counter) -> bool:
    """Whether every occurrence takes effect."""
    return counter.is_phase_known and counter.prescaler == 1 and first_effect(counter) == 1


def max_distance(counter: Counter) -> int:
    """Maximum number of occurrences from one that takes effect to the next."""
    return counter.prescaler + (not counter.is_phase_known and not counter.source) + counter.jitter


def min_distance(counter: Counter) -> int:
    """Minimum number of occurrences from one that takes effect to the next."""
    return max(1, counter.prescaler - counter.jitter)


def composed(outer: Counter, inner: Counter) -> Counter:
    """The counter of what happens at occurrences that `inner` lets take effect, of those that `outer` lets take effect."""
    if is_always(inner):
        return outer
    if is_always(outer):
        return inner
    return Counter(
        prescaler=outer.prescaler * inner.prescaler,
        offset=first_effect(outer) + (first_effect(inner) - 1) * outer.prescaler,
        is_phase_known=outer.is_phase_known and inner.is_phase_known,
        jitter=outer.jitter + inner.jitter * outer.prescaler,
    )


def of_one_in(counter: Counter, number: int, count: int) -> Counter | None:
    """The counter that one of several consecutive occurrences sees; None if it never takes effect there.

    Parameters
    ----------
    number : of the occurrence, counted from 1
    count : occurrences in each execution of the caller
    """
    # Execution k of the caller contains occurrence (k - 1) * count + number.
    first, prescaler = first_effect(counter), counter.prescaler
    common = gcd(count, prescaler)
    if (first - number) % common:
        return None
    cycle = prescaler // common
    residue = (first - number) // common * pow(count // common, -1, cycle) % cycle
    least = max(0, -((number - first) // count))
    return Counter(prescaler=cycle, offset=least + (residue - least) % cycle + 1, is_phase_known=counter.is_phase_known)


@dataclass(frozen=True, slots=True, eq=False)
class _Site:
    """A place in the model that executes a runnable.

    Attributes
    ----------
    call : None if it is not a call
    is_certain : whether each execution of the caller reaches it exactly once
    is_ordered : whether the order of the calls of a caller is known there
    """

    caller: _Caller
    call: Call | None = None
    is_certain: bool = False
    is_ordered: bool = False


@dataclass(frozen=True)
class CallSites:
    """The places at which each runnable of a system is executed."""

    system: System

    def lifted(self, call: Call, inner: Counter) -> Counter | None:
        """In which executions of the caller a call executes a part of its runnable; None if never.

        Parameters
        ----------
        inner : in which executions of the runnable that part is executed

        Raises
        ------
        UnknownError : the call is not reached exactly once in each execution, or the executions by others count, too.
        """
        if is_always(inner) and call.counter is None:
            return ALWAYS
        if call.counter is not None and call.counter.prescaler < 1:
            raise UnknownError("which executions it counts is unknown")
        here = self._of_calls.get(id(call), [])
        if len(here) != 1 or not here[0].is_certain:
            raise UnknownError("which executions it counts is unknown")
        (site,) = here
        every = self._of_runnables[call.runnable]
        if is_always(inner) or len(every) == 1:
            return composed(call.counter or ALWAYS, inner)
        if not all(other.caller == site.caller and other.is_ordered and _is_uncounted(other) for other in every):
            raise UnknownError("which executions it counts is unknown")
        return of_one_in(inner, every.index(site) + 1, len(every))

    @cached_property
    def sizes(self) -> Mapping[str, int]:
        """The activities that an execution of each runnable reaches, with those of called runnables at each call.

        Each runnable is counted once, because the number can double with each level of calls. In a circle of calls, at least one
        call counts as one activity.
        """
        found: dict[str, int] = {}
        runnables = self.system.runnables
        for name in bottom_up(
            runnables, lambda name: (called for called in called_runnables(runnables[name].activities) if called in runnables)
        ):
            found[name] = reached(runnables[name].activities, found)
        return found

    @cached_property
    def _of_calls(self) -> dict[int, list[_Site]]:
        """By the identity of the call; equal calls are different places."""
        found: dict[int, list[_Site]] = {}
        for sites in self._of_runnables.values():
            for site in sites:
                if site.call is not None:
                    found.setdefault(id(site.call), []).append(site)
        return found

    @cached_property
    def _of_runnables(self) -> dict[str, list[_Site]]:
        """By the name of the runnable; those that no process executes are left out."""
        found: dict[str, list[_Site]] = {}
        waiting: list[tuple[_Caller, tuple[Activity, ...]]]
        waiting = [((True, name), process.activities) for name, process in self.system.processes.items()]
        while waiting:
            caller, activities = waiting.pop()
            for name, site in self._within(activities, _Site(caller, is_certain=True, is_ordered=True)):
                if name not in found and name in self.system.runnables:
                    waiting.append(((False, name), self.system.runnables[name].activities))
                found.setdefault(name, []).append(site)
        return found

    def _within(self, activities: tuple[Activity, ...], around: _Site) -> Iterator[tuple[str, _Site]]:
        """The runnables that activities execute, in order."""
        for activity in activities:
            match activity:
                case Call(runnable=name):
                    is_certain = around.is_certain and self._is_once(activity)
                    yield name, _Site(around.caller, activity, is_certain, around.is_ordered)
                case ServerCall(runnable=name, result=result):
                    yield from ((called, _Site(around.caller)) for called in (name, result) if called)
                case SenderReceiverAccess(notifies=names):
                    yield from ((called, _Site(around.caller)) for called in names)
            if not isinstance(activity, WITH_PARTS):
                continue
            is_group = isinstance(activity, Group)
            inside = replace(
                around,
                is_certain=around.is_certain and is_group,
                is_ordered=around.is_ordered and isinstance(activity, Group) and activity.ordered,
            )
            for inner in inner_activities(activity):
                yield from self._within(inner, inside)

    def _is_once(self, call: Call) -> bool:
        runnable = self.system.runnables.get(call.runnable)
        return call.times is None and (runnable is None or runnable.condition is None)


def reached(activities: tuple[Activity, ...], sizes: Mapping[str, int]) -> int:
    """The activities that one execution of some activities reaches, with those of called runnables at each call."""
    here = list(walk(activities))
    return len(here) + sum(sizes.get(activity.runnable, 0) for activity in here if isinstance(activity, Call))


def _is_uncounted(site: _Site) -> bool:
    """Whether each execution of the caller executes the runnable there exactly once."""
    return site.is_certain and site.call is not None and site.call.counter is None


def flaw_of(counter: Counter | None, what: str) -> str:
    """Why the counter of something has no meaning; "" if it has one, or if there is none."""
    if counter is None or counter.prescaler >= 1:
        return ""
    return f"the counter of {what} has the prescaler {counter.prescaler}, which has no meaning"


def flaw_of_activity(activity: Activity) -> str:
    """The same for the counter of an activity."""
    counter = getattr(activity, "counter", None)
    match activity:
        case Call(runnable=name):
            return flaw_of(counter, f"the call of {name!r}")
        case Trigger(stimulus=name):
            return flaw_of(counter, f"the trigger of {name!r}")
    return flaw_of(counter, f"a {type(activity).__name__}")


@dataclass(frozen=True)
class CounterFlaws:
    """The counters of a system that have no meaning."""

    system: System

    def of_process(self, process: Process) -> str:
        """Why it is unknown what the jobs of a process do; "" if it is known. A trigger itself takes no time."""
        return next((flaw for each, flaw in self._in(process) if not isinstance(each, Trigger)), "")

    def of_stimulus(self, name: str) -> str:
        """Why it is unknown when a stimulus activates processes; "" if no counter makes it unknown."""
        return self._of_stimuli.get(name, "")

    @cached_property
    def _of_stimuli(self) -> Mapping[str, str]:
        found: dict[str, str] = {}
        for stimulus in self.system.stimuli.stimuli:
            if isinstance(stimulus, InterProcess | EventTriggered):
                found[stimulus.name] = flaw_of(stimulus.counter, f"the stimulus {stimulus.name!r}")
        for process in self.system.processes.values():
            for activity, flaw in self._in(process):
                if isinstance(activity, Trigger):
                    found[activity.stimulus] = found.get(activity.stimulus) or flaw
        return found

    def _in(self, process: Process) -> Iterator[tuple[Activity, str]]:
        if self._are_any:
            yield from ((each, flaw) for each in executed(process.activities, self.system) if (flaw := flaw_of_activity(each)))

    @cached_property
    def _are_any(self) -> bool:
        return any(flaw_of_activity(activity) for body in self.system.software.bodies for activity in walk(body))
