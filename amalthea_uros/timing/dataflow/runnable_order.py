"""Order constraints: which executions of runnables belong together, and whether they are in the required order.

All runnables of a group terminate before one of the next group starts; the order within a group is free. Where each process calls
all of the runnables, each job is judged alone. Where they are called by several processes, the first executions of all runnables
belong together, then the second ones, and so on. This needs processes that are activated equally often.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import Call, Trigger
from amalthea_uros.perf.constraints import OrderConstraint, Ordering
from amalthea_uros.perf.stimuli import InterProcess, Periodic
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.events import EventLocator
from amalthea_uros.timing.jobs.counters import is_always
from amalthea_uros.timing.jobs.positions import ActivityPosition, can_be_skipped, ends_early


@dataclass(frozen=True, slots=True)
class OrderScope:
    """Where an order constraint holds.

    Attributes
    ----------
    alone : the processes of which each job has to keep the order by itself
    together : the calls that have to keep it across processes, by the names of the runnables; each process executes its call once
        per job
    reason : why it is unknown which executions belong together
    """

    alone: tuple[str, ...] = ()
    together: Mapping[str, ActivityPosition] = field(default_factory=dict)
    reason: str = ""

    @property
    def processes(self) -> tuple[str, ...]:
        """The processes that have to keep the order together."""
        return tuple(dict.fromkeys(position.process.name for position in self.together.values()))


def order_scope(constraint: OrderConstraint, system: System, events: EventLocator) -> OrderScope:
    """Where an order constraint holds."""
    try:
        return _scope(constraint, system, events)
    except UnknownError as error:
        return OrderScope(reason=str(error))


def _scope(constraint: OrderConstraint, system: System, events: EventLocator) -> OrderScope:
    wanted = {name for group in constraint.groups for name in group}
    within = [name for name in constraint.processes or system.processes if name in system.processes]
    calls = {process: _calls(process, wanted, events) for process in within}
    callers = {process: {called_runnable(call) for call in found} for process, found in calls.items() if found}
    everywhere = set().union(*callers.values())
    elsewhere = [name for name in sorted(wanted - everywhere) for other in system.processes if _calls(other, {name}, events)]
    if elsewhere:
        raise UnknownError(f"{elsewhere[0]!r} is only called by processes outside of the scope")
    if not callers:
        first = next((name for group in constraint.groups for name in group), None)
        raise UnknownError(f"no process calls its runnables, such as {first!r}" if first else "it names no runnables")
    if everywhere < wanted or all(names == wanted for names in callers.values()):
        for call in (call for found in calls.values() for call in found):
            _require_direct(call)
        return OrderScope(alone=tuple(callers))
    return OrderScope(together=_together([call for found in calls.values() for call in found], system, events))


def satisfies_order(called: Sequence[str], constraint: OrderConstraint) -> bool:
    """Whether the groups follow each other and each runnable is called once; the order within a group is free."""
    members = [set(group) for group in constraint.groups]
    position = [next((i for i, group in enumerate(members) if name in group), None) for name in called]
    found = [(i, number) for i, number in enumerate(position) if number is not None]
    numbers = [number for _, number in found]
    if numbers != sorted(numbers) or len(found) != sum(map(len, members)):
        return False
    if constraint.ordering is Ordering.SUCCESSOR:
        return True
    first, last = found[0][0], found[-1][0]
    if last - first + 1 != len(found):
        return False
    match constraint.ordering:
        case Ordering.IMMEDIATE_AT_START:
            return first == 0
        case Ordering.IMMEDIATE_AT_END:
            return last == len(called) - 1
    return True


def _calls(process: str, wanted: set[str], events: EventLocator) -> list[ActivityPosition]:
    """The calls of some runnables in the jobs of a process."""
    return [each for each in events.positions(process) if isinstance(each.activity, Call) and each.activity.runnable in wanted]


def called_runnable(call: ActivityPosition) -> str:
    """The runnable that a call executes."""
    assert isinstance(call.activity, Call)
    return call.activity.runnable


def _require_direct(call: ActivityPosition) -> None:
    """Refuse a call within a runnable: what is in between then is not stated, and neither is what ends first."""
    if call.runnable is not None:
        raise UnknownError(f"{called_runnable(call)!r} is called by the runnable {call.runnable!r}, and not by a process")


def _together(calls: Sequence[ActivityPosition], system: System, events: EventLocator) -> Mapping[str, ActivityPosition]:
    found: dict[str, ActivityPosition] = {}
    for call in calls:
        name = called_runnable(call)
        _require_direct(call)
        if name in found:
            raise UnknownError(
                f"{name!r} is called at several positions, so it is unknown which of its executions belong to the others"
            )
        if not is_once_per_job(call, system) or any(map(ends_early, events.positions(call.process.name))):
            raise UnknownError(f"jobs of {call.process.name!r} need not execute {name!r} exactly once")
        found[name] = call
    sources = {_source(call.process.name, system, events): call.process.name for call in found.values()}
    if len(sources) > 1:
        one, other = list(sources.values())[:2]
        raise UnknownError(f"{one!r} and {other!r} are not activated equally often, so their executions do not correspond")
    return found


def are_activated_together(one: str, other: str, system: System, events: EventLocator) -> bool:
    """Whether it is certain that two processes are activated equally often."""
    try:
        return one == other or _source(one, system, events) == _source(other, system, events)
    except UnknownError:
        return False


def is_once_per_job(position: ActivityPosition, system: System) -> bool:
    """Whether each job executes an activity exactly once."""
    is_counted = position.counter is None or not is_always(position.counter) or has_counted_effect(position)
    return not is_counted and position.times == 1 and not can_be_skipped(position, system, {})


def has_counted_effect(position: ActivityPosition) -> bool:
    """Whether jobs reach a trigger that has no effect in each of them."""
    return isinstance(position.activity, Trigger) and position.activity.counter is not None


def _source(process: str, system: System, events: EventLocator, above: frozenset[str] = frozenset()) -> object:
    """What activates a process, the same for all processes that are activated equally often."""
    names = system.processes[process].stimuli
    stimulus = system.stimuli_by_name.get(names[0]) if len(names) == 1 else None
    match stimulus:
        case Periodic(period=period, condition=None):
            return period
        case InterProcess(counter=None, condition=None) if process not in above:
            fired = [
                each
                for each in events.all_positions()
                if isinstance(each.activity, Trigger) and each.activity.stimulus in names
            ]
            if len(fired) == 1 and is_once_per_job(fired[0], system):
                return _source(fired[0].process.name, system, events, above | {process})
    if stimulus is None:
        raise UnknownError(f"{process!r} is not activated by a single stimulus, so its executions do not correspond to others")
    return stimulus.name
