"""Non-preemptive regions of a job, in which others cannot preempt it: critical sections, non-interruptible groups, cooperative code.

The walk goes through groups, switches and calls at any depth. For each list of activities it keeps the longest demands between the
points at which the job can be preempted. Lists that follow each other are joined at their ends; of alternatives the longest counts.

A cooperative task can be preempted by other cooperative tasks at schedule points and between a call of a runnable and what follows it,
at any depth; several activities in a row are one region, and a job ends at once after its last call. A schedule point has no effect
while a job holds a semaphore whose ceiling keeps the other one off, or in a non-interruptible group.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import reduce
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import (
    Activity,
    Call,
    Group,
    Loop,
    ProbabilitySwitch,
    SchedulePoint,
    SemaphoreAccess,
    SemaphoreOperation,
    Switch,
    Terminate,
    walk,
)
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.system import System
from amalthea_uros.timing.demand.model import DemandModel
from amalthea_uros.timing.jobs.executed import MAX_CALL_DEPTH
from amalthea_uros.units import Time

#: The semaphores that a job holds.
Held: TypeAlias = frozenset[str]
#: The maximum demand of one activity, and the branches of a switch that can be taken.
DemandOf: TypeAlias = Callable[[Activity], Time]
Branches: TypeAlias = Callable[[Switch], Sequence[tuple[Activity, ...]]]


@dataclass(frozen=True, slots=True)
class RegionKind:
    """Where a job keeps another one off; within non-interruptible groups it always does.

    Attributes
    ----------
    semaphores : while it holds one of these
    throughout : everywhere apart from schedule points
    yields_after_calls : with `throughout`, the other one can also run after each call of a runnable
    """

    semaphores: frozenset[str] = frozenset()
    throughout: bool = False
    yields_after_calls: bool = False


@dataclass(frozen=True, slots=True)
class NonPreemptiveRegions:
    """Maximum demands between points of preemption, over all ways through some activities; None: there is no such way.

    Attributes
    ----------
    through : of ways without such a point
    first, inner, last : before the first point, between two points, and after the last one
    before_last : of all activities before the last point that counts: one after a call only counts if something follows
    after_call : of ways that end with a point after a call
    uncounted : of ways without a point that counts
    total : of all activities
    """

    through: Time | None
    first: Time | None = None
    inner: Time | None = None
    last: Time | None = None
    before_last: Time | None = None
    after_call: Time | None = None
    uncounted: Time | None = None
    total: Time = 0

    @property
    def longest(self) -> Time:
        """The longest stretch."""
        return _longest(self.through, self.first, self.inner, self.last) or 0

    def then(self, other: NonPreemptiveRegions) -> NonPreemptiveRegions:
        """These activities followed by others."""
        return NonPreemptiveRegions(
            through=_sum(self.through, other.through),
            first=_longest(self.first, _sum(self.through, other.first)),
            inner=_longest(self.inner, other.inner, _sum(self.last, other.first)),
            last=_longest(other.last, _sum(self.last, other.through)),
            before_last=_longest(
                _sum(self.total, other.before_last),
                None if other.uncounted is None else self.before_last,
                self.after_call if other.uncounted else None,
            ),
            after_call=_longest(_sum(self.total, other.after_call), self.after_call if other.uncounted == 0 else None),
            uncounted=_sum(self.uncounted, other.uncounted),
            total=self.total + other.total,
        )

    def either(self, other: NonPreemptiveRegions) -> NonPreemptiveRegions:
        """These activities or others."""
        return NonPreemptiveRegions(
            through=_longest(self.through, other.through),
            first=_longest(self.first, other.first),
            inner=_longest(self.inner, other.inner),
            last=_longest(self.last, other.last),
            before_last=_longest(self.before_last, other.before_last),
            after_call=_longest(self.after_call, other.after_call),
            uncounted=_longest(self.uncounted, other.uncounted),
            total=max(self.total, other.total),
        )

    def repeated(self, total: Time) -> NonPreemptiveRegions:
        """The same several times, with a total demand: a stretch is then at most all of it."""

        def at_most(value: Time | None) -> Time | None:
            return total if value else value

        return NonPreemptiveRegions(
            through=at_most(self.through),
            first=at_most(self.first),
            inner=_longest(at_most(self.inner), at_most(_sum(self.last, self.first))),
            last=at_most(self.last),
            before_last=None if self.first is None else total,
            uncounted=None if self.first is not None else total,
            total=total,
        )


#: Nothing; a point of preemption; and one after a call.
NOTHING = NonPreemptiveRegions(through=0, uncounted=0)
POINT = NonPreemptiveRegions(through=None, first=0, inner=0, last=0, before_last=0)
AFTER_CALL = NonPreemptiveRegions(through=None, first=0, inner=0, last=0, after_call=0, uncounted=0)


def _sum(first: Time | None, then: Time | None) -> Time | None:
    return None if first is None or then is None else first + then


def _longest(*values: Time | None) -> Time | None:
    return max((value for value in values if value is not None), default=None)


@dataclass(slots=True)
class RegionWalk:
    """Finds the stretches in which a process keeps another one off.

    Attributes
    ----------
    demand_of : maximum demand of an activity
    branches : of a switch
    requests : for each semaphore, those that the process requests while it holds it
    """

    system: System
    kept_off: RegionKind
    demand_of: DemandOf
    branches: Branches
    requests: dict[str, set[str]] = field(default_factory=dict)
    _of_runnables: dict[tuple[str, Held, bool], tuple[NonPreemptiveRegions, Held]] = field(default_factory=dict)
    _is_plain: dict[str, bool] = field(default_factory=dict)

    def of(self, activities: Sequence[Activity]) -> NonPreemptiveRegions:
        """The stretches of the body of a process.

        Raises
        ------
        UnknownError : it does not release what it requests on every way, or requests what it holds.
        """
        found, held = self._through(activities, frozenset(), False, ())
        if held:
            raise UnknownError(f"it does not release the semaphore {min(held)!r}")
        return found

    def _is_kept_off(self, held: Held, inside: bool) -> bool:
        """Whether the other one is kept off even at schedule points."""
        return inside or not held.isdisjoint(self.kept_off.semaphores)

    def _point(self, held: Held, inside: bool) -> NonPreemptiveRegions:
        """A point at which the job could be preempted."""
        return NOTHING if self._is_kept_off(held, inside) else POINT

    def _end(self, held: Held, inside: bool) -> NonPreemptiveRegions:
        """The end of a section or group: a point of preemption if nothing else keeps the other one off."""
        return NOTHING if self.kept_off.throughout else self._point(held, inside)

    def _through(
        self, activities: Iterable[Activity], held: Held, inside: bool, above: tuple[str, ...]
    ) -> tuple[NonPreemptiveRegions, Held]:
        found = NOTHING
        for activity in activities:
            here, held = self._one(activity, held, inside, above)
            found = found.then(here)
        return found, held

    def _one(self, activity: Activity, held: Held, inside: bool, above: tuple[str, ...]) -> tuple[NonPreemptiveRegions, Held]:
        """The stretches of one activity, and the semaphores that are held after it."""
        match activity:
            case SemaphoreAccess():
                after = _held_after(activity, held)
                for name in held & after:
                    self.requests.setdefault(name, set()).update(after - held)
                return self._executed(activity, held | after, inside).then(self._end(after, inside)), after
            case Group(activities=inner, ordered=ordered, interruptible=interruptible):
                within = inside or not interruptible
                if ordered:
                    found, after = self._through(inner, held, within, above)
                else:
                    found, after = self._in_any_order(inner, held, within, above), held
                return (found if within == inside else found.then(self._end(after, inside))), after
            case Call():
                return self._call(activity, held, inside, above)
            case Switch():
                return self._one_of(self.branches(activity), held, inside, above)
            case ProbabilitySwitch(branches=branches):
                return self._one_of([branch.activities for branch in branches], held, inside, above)
            case Loop(activities=inner):
                found, _ = self._unchanged(inner, held, inside, above, "a loop")
                return NOTHING.either(found), held
            case SchedulePoint() if self.kept_off.throughout:
                return self._executed(activity, held, inside).then(self._point(held, inside)), held
            case Terminate() if held:
                raise UnknownError(f"it terminates while it holds the semaphore {min(held)!r}")
        return self._executed(activity, held, inside), held

    def _executed(self, activity: Activity, held: Held, inside: bool) -> NonPreemptiveRegions:
        """The demand of an activity without parts."""
        demand = self.demand_of(activity)
        if self.kept_off.throughout or self._is_kept_off(held, inside):
            return NonPreemptiveRegions(through=demand, uncounted=demand, total=demand)
        return (
            NonPreemptiveRegions(through=None, first=0, inner=0, last=0, before_last=demand, total=demand)
            if demand
            else NOTHING
        )

    def _unchanged(
        self, activities: Iterable[Activity], held: Held, inside: bool, above: tuple[str, ...], where: str
    ) -> tuple[NonPreemptiveRegions, Held]:
        """The stretches of activities that may be skipped or repeated, which must release what they request."""
        found, after = self._through(activities, held, inside, above)
        if after != held:
            raise UnknownError(f"{where} requests or releases the semaphore {min(after ^ held)!r} only")
        return found, held

    def _one_of(
        self, alternatives: Sequence[Sequence[Activity]], held: Held, inside: bool, above: tuple[str, ...]
    ) -> tuple[NonPreemptiveRegions, Held]:
        found = [self._through(each, held, inside, above) for each in alternatives]
        if not found:
            return NOTHING, held
        after = found[0][1]
        for _, other in found:
            if other != after:
                raise UnknownError(f"only some branches of a switch request or release the semaphore {min(other ^ after)!r}")
        return reduce(NonPreemptiveRegions.either, (stretches for stretches, _ in found)), after

    def _in_any_order(
        self, activities: Sequence[Activity], held: Held, inside: bool, above: tuple[str, ...]
    ) -> NonPreemptiveRegions:
        """The stretches of activities in unknown order: each pair may follow each other, with all others in between."""
        parts = [self._unchanged((each,), held, inside, above, "a part of an unordered group")[0] for each in activities]
        if not parts:
            return NOTHING
        through = sum(part.through or 0 for part in parts)
        total = sum(part.total for part in parts)
        with_points = [part for part in parts if part.first is not None]
        one = reduce(NonPreemptiveRegions.either, parts)
        between = _sum(_sum(one.last, one.first), through) if len(with_points) > 1 else None
        return NonPreemptiveRegions(
            through=None if any(part.through is None for part in parts) else through,
            first=_sum(one.first, through),
            inner=_longest(one.inner, between),
            last=_sum(one.last, through),
            before_last=total if with_points else None,
            uncounted=None if with_points else total,
            total=total,
        )

    def _call(self, call: Call, held: Held, inside: bool, above: tuple[str, ...]) -> tuple[NonPreemptiveRegions, Held]:
        runnable = self.system.runnables.get(call.runnable)
        if runnable is None or runnable.name in above or len(above) > MAX_CALL_DEPTH:
            # Demand is unknown then, so that the stretches do not matter.
            return NOTHING, held
        yields = self.kept_off.throughout and self.kept_off.yields_after_calls
        is_conditional = call.counter is not None or runnable.condition is not None or call.times is not None
        if self._plain(runnable.name):
            found, after = self._executed(call, held, inside), held
        else:
            key = (runnable.name, held, inside)
            if key not in self._of_runnables:
                self._of_runnables[key] = self._through(runnable.activities, held, inside, (*above, runnable.name))
            found, after = self._of_runnables[key]
            if call.times is not None:
                found = found.repeated(self.demand_of(call))
        if is_conditional and after != held:
            name = min(after ^ held)
            raise UnknownError(f"only some jobs call {runnable.name!r}, which requests or releases the semaphore {name!r}")
        if yields and not self._is_kept_off(after, inside):
            found = found.then(AFTER_CALL)
        return (NOTHING.either(found) if is_conditional else found), after

    def _plain(self, name: str) -> bool:
        """Whether a runnable has nothing that begins or ends a stretch, at any depth."""
        if name not in self._is_plain:
            self._is_plain[name] = True  # a recursive call adds nothing
            self._is_plain[name] = self._has_nothing_special(name)
        return self._is_plain[name]

    def _has_nothing_special(self, name: str) -> bool:
        runnable = self.system.runnables[name]
        for activity in walk(runnable.activities):
            match activity:
                case SemaphoreAccess() | SchedulePoint() | Terminate() | Group(interruptible=False):
                    return False
                case Call() if self.kept_off.throughout and self.kept_off.yields_after_calls:
                    return False
                case Call(runnable=inner) if inner in self.system.runnables and not self._plain(inner):
                    return False
        return True


def _held_after(access: SemaphoreAccess, held: Held) -> Held:
    if access.operation is SemaphoreOperation.RELEASE:
        if access.semaphore not in held:
            raise UnknownError(f"it releases the semaphore {access.semaphore!r}, which it does not hold")
        return held - {access.semaphore}
    if access.semaphore in held:
        raise UnknownError(f"it requests the semaphore {access.semaphore!r}, which it holds already")
    return held | {access.semaphore}


@dataclass(slots=True)
class ProcessRegions:
    """The stretches of processes, each found once."""

    demand_model: DemandModel
    _found: dict[tuple[str, str, RegionKind], NonPreemptiveRegions] = field(default_factory=dict)

    def of(self, process: Process, core: str, kept_off: RegionKind) -> NonPreemptiveRegions:
        """The stretches of the jobs of a process on a core, in its time base; raises as `RegionWalk.of`."""
        key = (process.name, core, kept_off)
        if key not in self._found:
            self._found[key] = self._find(process, core, kept_off)
        return self._found[key]

    def _find(self, process: Process, core: str, kept_off: RegionKind) -> NonPreemptiveRegions:
        model = self.demand_model

        def demand_of(activity: Activity) -> Time:
            return model.of_activities(process, (activity,), core).worst

        return RegionWalk(model.system, kept_off, demand_of, model.possible_branches).of(process.activities)
