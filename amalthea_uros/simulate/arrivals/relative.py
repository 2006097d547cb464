"""Occurrences of which each follows the one before at a varying distance; also what is called sporadic."""

from __future__ import annotations

import numpy as np

from amalthea_uros.perf.distributions import lowest
from amalthea_uros.perf.stimuli import RelativePeriodic
from amalthea_uros.simulate.arrivals.occurrences import Block, Blocks, UnknownArrivalError, block_size
from amalthea_uros.simulate.options import Mode
from amalthea_uros.simulate.sampling.random_source import RandomSource
from amalthea_uros.simulate.sampling.streams import Stream, values

#: The worst case has the shortest distances.
_OF_DISTANCES = {Mode.WORST: Mode.BEST, Mode.BEST: Mode.WORST}

#: An assumption.
NO_LONGER = "occurrences of sporadic stimuli without a maximum distance are no farther apart than specified"


def relative(stimulus: RelativePeriodic, mode: Mode, source: RandomSource, time_base: int) -> Blocks:
    """The occurrences of a relative periodic stimulus: the shortest distances in the worst case, the longest in the best.

    Raises
    ------
    UnknownArrivalError : a distance or the offset is negative, or all distances are zero.
    """
    distances = values(stimulus.distance, _OF_DISTANCES.get(mode, mode), source)
    if stimulus.offset < 0:
        raise UnknownArrivalError("its offset is negative")
    if distances.lowest < 0 or (lowest(stimulus.distance) or 0) < 0:
        raise UnknownArrivalError("the distance of its occurrences can be negative")
    if distances.highest == 0:
        raise UnknownArrivalError("the distance of its occurrences is zero")
    block_size(stimulus.offset * time_base)
    return _relative(stimulus.offset * time_base, distances, time_base, block_size(distances.highest * time_base))


def _relative(start: int, distances: Stream, time_base: int, size: int) -> Blocks:
    yield Block(start, np.array([start], np.int64))
    while True:
        times = start + np.cumsum(distances.take(size)) * time_base
        start = int(times[-1])
        yield Block(start, times)
