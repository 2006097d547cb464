"""Periodic stimuli with and without jitter, lists of times, bursts, and sporadic stimuli."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import count

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.distributions import lowest
from amalthea_uros.perf.stimuli import Burst, Periodic, RelativePeriodic, Synthetic
from amalthea_uros.simulate.arrivals.occurrences import OccurrenceBlock, OccurrenceBlocks, block_size
from amalthea_uros.simulate.options import SimulationMode
from amalthea_uros.simulate.sampling.streams import ValueStream, constant, values
from amalthea_uros.simulate.sampling.variates import variate
from amalthea_uros.simulate.sampling.words import RandomSource
from amalthea_uros.timing.event_models.stimuli import MAX_OCCURRENCES


def synthetic(stimulus: Synthetic, time_base: int) -> OccurrenceBlocks:
    """The occurrences of a list of times; times after the period overlap with the next one."""
    if not stimulus.times:
        raise UnknownError("it has no occurrence times")
    if min(stimulus.times) < 0:
        raise UnknownError("an occurrence time is negative")
    return repeated(stimulus.offset, stimulus.period, stimulus.times, time_base)


def burst(stimulus: Burst, time_base: int) -> OccurrenceBlocks:
    """The occurrences of bursts; whether one at exactly the end of a burst is clipped is not specified: it occurs."""
    if stimulus.distance < 0:
        raise UnknownError("the distance of the occurrences in a burst is negative")
    clipped = max(stimulus.length, 0) // stimulus.distance + 1 if stimulus.distance else stimulus.count
    number = min(stimulus.count, clipped)
    if not 0 < number <= MAX_OCCURRENCES:
        raise UnknownError(f"the number of occurrences in a burst is not between 1 and {MAX_OCCURRENCES}")
    return repeated(stimulus.offset, stimulus.period, [i * stimulus.distance for i in range(number)], time_base)


def repeated(offset: int, period: int, times: Sequence[int], time_base: int) -> OccurrenceBlocks:
    """Numbers that are repeated with a period; arguments in picoseconds.

    Raises
    ------
    UnknownError : the period is not positive.
    """
    if period <= 0:
        raise UnknownError("its period is not greater than zero")
    size = max(1, block_size(period * time_base) // len(times))
    block_size(max(abs(offset), *times, 0) * time_base)
    return _repeated(offset, period, times, time_base, size)


def _repeated(offset: int, period: int, times: Sequence[int], time_base: int, size: int) -> OccurrenceBlocks:
    """The blocks of `size` periods each."""
    # Each time as the number of the first period with it, and its place in a period.
    parts = sorted((time % period, time // period) for time in times)
    places = np.array([place for place, _ in parts], np.int64) * time_base
    firsts = np.array([first for _, first in parts], np.int64)
    for start in count(max(0, -(offset // period)), size):
        periods = np.arange(start, start + size)[:, None]
        found = (offset + periods * period) * time_base + places
        has_begun = periods >= firsts
        end = (offset + (start + size) * period) * time_base
        yield OccurrenceBlock(end, found.ravel() if start >= firsts.max() else found[has_begun])


# Periodic stimuli: an ideal grid, and jitter that does not accumulate.

#: An assumption.
AT_0 = "occurrences that jitter would move to before the start of the simulation occur at its start"


def periodic(stimulus: Periodic, mode: SimulationMode, source: RandomSource, time_base: int) -> OccurrenceBlocks:
    """The occurrences of a periodic stimulus.

    If values are not sampled, the jitter is constant: its greatest value in the worst case, its least in the best.
    """
    jitter = constant(0) if stimulus.jitter is None else values(stimulus.jitter, mode, source)
    distance = max(0, stimulus.min_distance or 0)
    if jitter.constant is not None and distance <= stimulus.period:
        return repeated(stimulus.offset + jitter.constant, stimulus.period, (0,), time_base)
    if stimulus.period <= 0:
        raise UnknownError("its period is not greater than zero")
    longest = max(abs(stimulus.offset), distance, stimulus.period, abs(jitter.lowest), abs(jitter.highest))
    return _jittered(stimulus, jitter, distance * time_base, time_base, block_size(longest * time_base * 4))


def before_0(stimulus: Periodic, mode: SimulationMode) -> bool:
    """Whether jitter can move an occurrence to before the start of the simulation."""
    if stimulus.jitter is None or mode is not SimulationMode.SAMPLED:
        return False
    jitter = variate(stimulus.jitter)
    return stimulus.offset + _first(stimulus, jitter.highest) * stimulus.period + jitter.lowest < 0


def _first(stimulus: Periodic, latest: int) -> int:
    """The number of the first period whose occurrence is not before 0 with the greatest jitter."""
    return max(0, -((stimulus.offset + latest) // stimulus.period))


def _jittered(stimulus: Periodic, jitter: ValueStream, distance: int, time_base: int, size: int) -> OccurrenceBlocks:
    """Occurrences in the order of time, also where jitter exceeds the period, and never closer than the distance.

    Those that jitter would put before 0 occur at 0, if a greater jitter could put them there; otherwise they are before the start of
    the simulation.
    """
    period = stimulus.period * time_base
    offset, earliest = stimulus.offset * time_base, jitter.lowest * time_base
    pending = np.empty(0, np.int64)
    last = -distance
    for start in count(_first(stimulus, jitter.highest), size):
        ideal = offset + np.arange(start, start + size) * period
        drawn = np.maximum(ideal + jitter.take(size) * time_base, 0)
        drawn = np.sort(np.concatenate((pending, drawn)))
        # No later one can be before this.
        end = max(0, offset + (start + size) * period + earliest)
        settled = int(np.searchsorted(drawn, end))
        times, pending = _at_distance(drawn[:settled], last, distance), drawn[settled:]
        last = int(times[-1]) if settled else last
        yield OccurrenceBlock(end, times)


def _at_distance(times: Numbers, last: int, distance: int) -> Numbers:
    """Numbers that are moved to later so that they have a distance, also from the last one before."""
    steps = np.arange(1, len(times) + 1) * distance
    return np.maximum(np.maximum.accumulate(times - steps), last) + steps


# Occurrences of which each follows the one before at a varying distance; also what is called sporadic.

#: The worst case has the shortest distances.
_OF_DISTANCES = {SimulationMode.WORST: SimulationMode.BEST, SimulationMode.BEST: SimulationMode.WORST}

#: An assumption.
NO_LONGER = "occurrences of sporadic stimuli without a maximum distance are no farther apart than specified"


def relative(stimulus: RelativePeriodic, mode: SimulationMode, source: RandomSource, time_base: int) -> OccurrenceBlocks:
    """The occurrences of a relative periodic stimulus: the shortest distances in the worst case, the longest in the best.

    Raises
    ------
    UnknownError : a distance or the offset is negative, or all distances are zero.
    """
    distances = values(stimulus.distance, _OF_DISTANCES.get(mode, mode), source)
    if stimulus.offset < 0:
        raise UnknownError("its offset is negative")
    if distances.lowest < 0 or (lowest(stimulus.distance) or 0) < 0:
        raise UnknownError("the distance of its occurrences can be negative")
    if distances.highest == 0:
        raise UnknownError("the distance of its occurrences is zero")
    block_size(stimulus.offset * time_base)
    return _relative(stimulus.offset * time_base, distances, time_base, block_size(distances.highest * time_base))


def _relative(start: int, distances: ValueStream, time_base: int, size: int) -> OccurrenceBlocks:
    yield OccurrenceBlock(start, np.array([start], np.int64))
    while True:
        times = start + np.cumsum(distances.take(size)) * time_base
        start = int(times[-1])
        yield OccurrenceBlock(start, times)
