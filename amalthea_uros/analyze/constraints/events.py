"""The windows in which events occur, relative to the activation of their process, and exact delays from one event to the next."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise, product
from math import lcm

import numpy as np

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.chains.evaluator import ChainEvaluator
from amalthea_uros.analyze.chains.job_chains import MAX_JOBS
from amalthea_uros.analyze.chains.read_write_times import ReadWriteBounds
from amalthea_uros.errors import UnknownError
from amalthea_uros.judge.evidence import Ends
from amalthea_uros.perf.activities import Call
from amalthea_uros.perf.constraints import DelayConstraint, OrderConstraint, Ordering
from amalthea_uros.perf.events import Event, EventSet
from amalthea_uros.timing.activation.releases import known_releases
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow.events import EventOccurrence, JobPhase
from amalthea_uros.timing.dataflow.runnable_order import (
    OrderScope,
    called_runnable,
    is_once_per_job,
    satisfies_order,
)
from amalthea_uros.timing.jobs.counters import is_always
from amalthea_uros.timing.jobs.positions import ActivityPosition, can_be_skipped, ends_early, is_in_fixed_order
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True)
class EventWindows:
    """The windows in which the events of a system occur."""

    evaluation: ChainEvaluator

    def event(self, name: str) -> Event:
        """An event of the model.

        Raises
        ------
        UnknownError : there is no such event, or it is a set of events.
        """
        event = self.evaluation.context.system.events_by_name.get(name)
        if event is None or isinstance(event, EventSet):
            raise UnknownError(f"{name!r} is not a single event of the model")
        return event

    def occurrence(self, name: str) -> EventOccurrence:
        """Where an event occurs.

        Raises
        ------
        UnknownError : it occurs at several positions, in some jobs only, or several times in a job.
        """
        occurrences = self.evaluation.context.dataflow.events.of(self.event(name))
        if len(occurrences) > 1:
            raise UnknownError(f"the event {name!r} occurs at several positions")
        position, context = occurrences[0].position, self.evaluation.context
        if position is not None and (
            position.counter is None
            or not is_always(position.counter)
            or can_be_skipped(position, context.system, context.settings.modes)
        ):
            raise UnknownError(f"the event {name!r} occurs in some jobs only")
        if position is not None and position.times != 1:
            raise UnknownError(f"the event {name!r} can occur several times in a job")
        return occurrences[0]

    def of(self, occurrence: EventOccurrence) -> tuple[Time, Time]:
        """The minimum and maximum time from the activation to an event."""
        response = self.evaluation.solution.responses.get(occurrence.process.name)
        if response is None or response.worst is None:
            raise UnknownError(f"the response time of {occurrence.process.name!r} is unknown or unbounded")
        if self.evaluation.solution.depends_on_losses(occurrence.process.name):
            raise UnknownError(f"{occurrence.process.name!r}, or a process that precedes it, can lose activations")
        bcet = self.evaluation.solution.bcet(occurrence.process.name)
        match occurrence.when:
            case JobPhase.ACTIVATION:
                return 0, 0
            case JobPhase.START:
                return 0, response.worst - bcet
            case JobPhase.END:
                return response.best, response.worst
        return 0, response.worst

    def spread(self, events: Sequence[str]) -> Ends:
        """The maximum time between corresponding occurrences of events of processes with the same period: between which ends."""
        windows = []
        periods, missing = set(), set()
        for name in events:
            occurrence = self.occurrence(name)
            releases = known_releases(occurrence.process, self.evaluation.context.system)
            if releases is None:
                raise UnknownError(f"the release times of {occurrence.process.name!r} are unknown")
            periods.add(releases.period)
            early, late = self.of(occurrence)
            offset = releases.offset % releases.period
            missing.add(releases.offset // releases.period)
            windows.append((offset + early, offset + late))
        if not windows:
            raise UnknownError("it has no events")
        if len(periods) > 1:
            raise UnknownError("its events have different periods, so their occurrences do not correspond")
        if len(missing) > 1:
            raise UnknownError("some of its events occur for the first time in a later period than others")
        apart = max(early for early, _ in windows) - min(late for _, late in windows)
        return Ends(max(0, apart), max(late for _, late in windows) - min(early for early, _ in windows))


def exact_delays(constraint: DelayConstraint, windows: EventWindows) -> tuple[Time, Time] | None:
    """The least and the greatest delay of a reaction; None unless the times of both events are known exactly."""
    evaluation, unit = windows.evaluation, windows.evaluation.timing.unit
    try:
        ends = [windows.occurrence(name) for name in (constraint.source, constraint.target)]
        source, target = (evaluation.timing.exact_times(end) for end in ends)
    except UnknownError:
        return None
    if source is None or target is None or len({evaluation.controller(end.process.name) for end in ends}) > 1:
        return None  # the clocks of controllers are not synchronized
    return _delays(source, target, (constraint.lower or 0) * unit, unit)


def _delays(source: ReadWriteBounds, target: ReadWriteBounds, lower: Time, unit: int) -> tuple[Time, Time] | None:
    """The least and the greatest time from a source to the first target that does not come before a lower limit after it.

    From the start of the system on, in picoseconds, rounded outwards; None if there are too many occurrences.

    Parameters
    ----------
    source, target : their reads are the times of the events
    unit : parts of a picosecond in which times are counted
    """
    events = [source.pessimistic, target.pessimistic]
    cycle = lcm(*(each.cycle for each in events))
    until = max(source.steady_state_start, target.steady_state_start) + 2 * cycle
    # The next target comes in the cycle after the source and the lower limit at the latest.
    longer = until + 2 * cycle + lower
    if sum(len(each.releases) * (longer // each.until + 1) for each in events) > MAX_JOBS:
        return None
    sources, targets = (np.sort(each.extended(longer).reads) for each in events)
    sources = sources[sources < until]
    found = targets[np.searchsorted(targets, sources + lower)] - sources
    return int(found.min()) // unit, -(-int(found.max()) // unit)


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
