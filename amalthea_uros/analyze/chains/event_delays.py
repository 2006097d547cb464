"""Delays from an event to the next one of another kind, where the times of both are known exactly."""

from __future__ import annotations

from math import lcm

import numpy as np

from amalthea_uros.analyze.chains.event_windows import EventWindows
from amalthea_uros.analyze.chains.job_chains import MAX_JOBS
from amalthea_uros.analyze.chains.stage_timing import UnboundedStageError
from amalthea_uros.analyze.chains.timed_stage import ReadWriteBounds
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.constraints import DelayConstraint
from amalthea_uros.timing.dataflow.events import UnresolvedError
from amalthea_uros.units import Time


def exact_delays(constraint: DelayConstraint, windows: EventWindows) -> tuple[Time, Time] | None:
    """The least and the greatest delay of a reaction; None unless the times of both events are known exactly."""
    evaluation, unit = windows.evaluation, windows.evaluation.timing.unit
    try:
        ends = [windows.occurrence(name) for name in (constraint.source, constraint.target)]
        source, target = (evaluation.timing.exact_times(end) for end in ends)
    except (UnknownError, UnresolvedError, UnboundedStageError):
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
