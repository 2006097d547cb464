"""Whether runnables are executed in the order that a constraint requires."""

from __future__ import annotations

from itertools import pairwise, product

from amalthea_uros.analyze.constraints.events import EventWindows
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import Call
from amalthea_uros.perf.constraints import OrderConstraint, Ordering
from amalthea_uros.timing.activation.releases import known_releases
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow.events import EventOccurrence, JobPhase
from amalthea_uros.timing.dataflow.runnable_order import (
    OrderScope,
    called_runnable,
    is_in_fixed_order,
    is_once_per_job,
    satisfies_order,
)
from amalthea_uros.timing.jobs.positions import ActivityPosition, ends_early
from amalthea_uros.units import Time


def holds_in_each_job(process: str, constraint: OrderConstraint, context: TimingContext) -> bool:
    """Whether each job of a process keeps an order.

    Raises
    ------
    UnknownError : that depends on the job.
    """
    wanted = {name for group in constraint.groups for name in group}
    positions = context.dataflow.events.positions(process)
    if any(map(ends_early, positions)):
        raise UnknownError(f"jobs of {process!r} can terminate before their last activity")
    calls = [each for each in positions if isinstance(each.activity, Call)]
    own = [call for call in calls if call.runnable is None]
    certain = [call for call in own if is_once_per_job(call, context.system) and is_in_fixed_order(call)]
    for call in calls:
        if called_runnable(call) in wanted and call not in certain:
            raise UnknownError(
                f"{process!r} does not execute {called_runnable(call)!r} exactly once, at the same point of each job"
            )
    holds = {satisfies_order([called_runnable(call) for call in some], constraint) for some in (own, certain)}
    if len(holds) > 1:
        raise UnknownError(f"it depends on the job of {process!r} which runnables it calls in between")
    return holds.pop()


def holds_across(scope: OrderScope, constraint: OrderConstraint, windows: EventWindows) -> bool:
    """Whether executions in several processes keep an order.

    Raises
    ------
    UnknownError : both are possible.
    """
    evaluation = windows.evaluation
    if len({evaluation.controller(name) for name in scope.processes}) > 1:
        raise UnknownError("the processes are on controllers whose clocks are not synchronized")
    groups = [[scope.together[name] for name in group] for group in constraint.groups if group]
    pairs = [pair for one, other in pairwise(groups) for pair in product(one, other)]
    holds = [_is_before(first, then, windows) for first, then in pairs]
    if False in holds:
        return False
    if None in holds:
        names = " and ".join(map(repr, scope.processes))
        raise UnknownError(f"the bounds of {names} do not decide which runnable is executed first")
    if constraint.ordering is not Ordering.SUCCESSOR:
        raise UnknownError("the order holds, but it is unknown which other runnables are executed in between")
    return True


def _is_before(first: ActivityPosition, then: ActivityPosition, windows: EventWindows) -> bool | None:
    """Whether an execution always ends before the corresponding one starts: always, never, or (None) unknown."""
    if first.process.name == then.process.name:
        is_fixed = is_in_fixed_order(first) and is_in_fixed_order(then)
        return first.last < then.number if is_fixed else None
    _, ended = ends = _window(EventOccurrence(first.process, JobPhase.AFTER, first), windows)
    starts = _window(EventOccurrence(then.process, JobPhase.BEFORE, then), windows)
    if ended <= starts[0]:
        return True
    return False if starts[1] < ends[0] else None


def _window(occurrence: EventOccurrence, windows: EventWindows) -> tuple[Time, Time]:
    """Between which times the first occurrence of an event is."""
    evaluation, process = windows.evaluation, occurrence.process
    system = evaluation.context.system
    releases = known_releases(process, system)
    if releases is None:
        raise UnknownError(f"the release times of {process.name!r} are unknown")
    early, late = windows.of(occurrence)
    return releases.offset + early, releases.offset + late
